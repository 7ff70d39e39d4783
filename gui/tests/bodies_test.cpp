// The machine that is drawn is the one whose bodies the gateway keeps apart.

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "gateway/sessions/messages.hpp"
#include "gui/models/machine_picture.hpp"
#include "gui/scene/machine_figure.hpp"

namespace kinebus::gui {
namespace {

MachineDescription shipped(const std::filesystem::path& file) {
  auto machine = load_machine(file);
  EXPECT_TRUE(machine) << to_string(machine.error());
  return std::move(*machine);
}

/// As it comes over the wire.
std::optional<MachineModel> model_of_file(const MachineDescription& machine) {
  joblink::MachineInfo told;
  EXPECT_TRUE(told.ParseFromString(to_message(machine, {}).SerializeAsString()));
  return model_of(told);
}

std::size_t near_parts(const MachineFigure& figure) {
  std::size_t count = 0;
  for (const FigurePart& part : figure.parts)
    if (part.finish == Finish::kNear) ++count;
  return count;
}

TEST(SceneBodies, AreThoseOfTheGatewayForEveryShippedMachine) {
  for (const auto& entry : std::filesystem::directory_iterator(kinebus::machines_folder())) {
    const MachineDescription machine = shipped(entry.path());
    const auto expected = make_collision_model(machine);
    const auto model = model_of_file(machine);
    ASSERT_TRUE(model && expected) << entry.path();
    EXPECT_TRUE(model->watched);
    std::mt19937 random(1);
    const auto in = [&](double low, double high) {
      return std::uniform_real_distribution<>(low, high)(random);
    };
    int reached = 0;
    for (int n = 0; n < 200; ++n) {
      const kinebus::Pose pose{in(-90, 90), in(-90, 90), in(0, 150), in(-0.4, 0.4), in(-3, 3), 0};
      const auto ours = model->solid->clearance(Frame::kPart, pose),
                 theirs = expected->clearance(Frame::kPart, pose);
      ASSERT_EQ(ours.has_value(), theirs.has_value()) << entry.path();
      if (!ours) continue;
      ++reached;
      EXPECT_DOUBLE_EQ(ours->mm, theirs->mm) << entry.path();
      EXPECT_EQ(ours->first, theirs->first);
      EXPECT_EQ(ours->second, theirs->second);
      const MachineFigure figure =
          pose_machine(*model, {{pose[kX], pose[kY], pose[kZ]}, pose[kA], pose[kC]}, false);
      EXPECT_GT(figure.parts.size(), 3u);
      EXPECT_EQ(near_parts(figure) > 0, theirs->mm < expected->wanted_mm() + kClose_mm);
    }
    EXPECT_GT(reached, 50) << entry.path();
  }
}

TEST(SceneBodies, ThePartsFrameIsWhereTheToolTouchesTheTable) {
  // M1: what lies at q of the part is at the nozzle when the tool is at q.
  const auto model = model_of_file(default_m1());
  ASSERT_TRUE(model);
  for (const PartPose pose : {PartPose{{0, 0, 0}, 0, 0}, PartPose{{50, -20, 30}, 0.7, 1.2}}) {
    const MachineFigure figure = pose_machine(*model, pose, false);
    const QVector3D at =
        figure.part_frame.map(QVector3D(static_cast<float>(pose.q_mm[0]), static_cast<float>(pose.q_mm[1]),
                                        static_cast<float>(pose.q_mm[2])));
    EXPECT_NEAR(at.x(), 0, 1e-2);
    EXPECT_NEAR(at.y(), 0, 1e-2);
    EXPECT_NEAR(at.z(), 1340, 1e-2);
  }
}

TEST(SceneBodies, TheTwoThatComeCloseAreColouredAndNoOther) {
  MachineDescription machine = default_m1();
  // Its inner face is 31 mm beside the table's rim.
  machine.bodies->fixed.push_back({"clamp", {131, -15, 1240}, {160, 15, 1339}});
  const auto model = model_of_file(machine);
  ASSERT_TRUE(model);
  EXPECT_EQ(near_parts(pose_machine(*model, {{0, 0, 20}, 0, 0}, false)), 0u);
  const MachineFigure close = pose_machine(*model, {{-27, 0, 20}, 0, 0}, false);
  ASSERT_TRUE(close.close);
  EXPECT_NEAR(close.close->mm, 4, 0.01);
  EXPECT_EQ(model->solid->name(close.close->first), "table");
  EXPECT_EQ(model->solid->name(close.close->second), "clamp");
  EXPECT_EQ(near_parts(close), 2u);
  // A gateway that keeps nothing apart: its machine is drawn, and nothing is coloured.
  machine.bodies.reset();
  const auto unwatched = model_of_file(machine);
  ASSERT_TRUE(unwatched);
  EXPECT_FALSE(unwatched->watched);
  EXPECT_FALSE(pose_machine(*unwatched, {{-27, 0, 20}, 0, 0}, false).parts.empty());
}

}  // namespace
}  // namespace kinebus::gui
