// An object of the print that is left out while the job runs.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "gateway/machine/tests/resume_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr int kLayers = 8;
constexpr double kSquare_mm = 0.4;  // filament of one square

/// Two squares of 10 mm, about X -20 and X 20, layer by layer, in lines short enough that the planner cannot
/// hold the whole job.
std::string two_squares() {
  std::string text =
      "G21 G90 M83 G64 P0.005 Q0\nEXCLUDE_OBJECT_DEFINE NAME=left\nEXCLUDE_OBJECT_DEFINE NAME=Right\n";
  for (int layer = 1; layer <= kLayers; ++layer) {
    const std::string z = std::to_string(0.3 * layer + 10);
    for (const bool right : {false, true}) {
      const int x = right ? 20 : -20;
      const auto to = [&](int dx, int dy) {
        return " X" + std::to_string(x + dx) + " Y" + std::to_string(dy);
      };
      text += std::string("EXCLUDE_OBJECT_START NAME=") + (right ? "Right" : "left") + "\n";
      text += "G1 E-0.5 F1800\nG0" + to(-5, -5) + " Z" + z + "\nG1 E0.5 F1800\n";
      constexpr int kParts = 200;
      text += "G91\nM83\nF2400\n";
      for (const char* side : {"X0.05", "Y0.05", "X-0.05", "Y-0.05"})
        for (int i = 0; i < kParts; ++i) text += std::string("G1") + side + "E0.0005\n";
      text += "G90\nM83\n";
      text += "EXCLUDE_OBJECT_END\n";
    }
  }
  return text + "G1 E-0.5 F1800\nG0 X0 Y0\n";
}

struct Printed {
  std::vector<Pose> track;
  double filament_mm = 0, begun_mm = 0;
  int right_layers = 0, left_layers = 0;  ///< in which filament was fed over this one
  std::string story;
};

/// Leaves the right one out at the time stated; another gateway takes over `killed_after` later.
Printed print(BusTime at, BusTime killed_after = 0s) {
  Printed made;
  ResumeRig rig;
  rig.job_text = two_squares();
  EXPECT_TRUE(rig.begin(0)) << rig.story();
  rig.track_ = &made.track;
  made.begun_mm = rig.pose()[kE];
  if (at > 0s) {
    rig.run(at);
    EXPECT_FALSE(rig.gateway->carry_out(command::ExcludeObject{"middle"}));
    EXPECT_TRUE(rig.gateway->carry_out(command::ExcludeObject{"RIGHT"})) << rig.story();
    const MachineStatus now = rig.gateway->status();
    EXPECT_EQ(now.objects.size(), 2U);
    EXPECT_TRUE(now.objects.size() == 2 && !now.objects[0].left_out && now.objects[1].left_out);
  }
  if (killed_after > 0s) {
    rig.run(killed_after);
    rig.replace_gateway();
    EXPECT_TRUE(rig.gateway->carry_out(command::Resume{})) << rig.story();
    EXPECT_TRUE(rig.run_until(
        [&] {
          rig.watch();
          return rig.gateway->state() == MachineState::kRunning && !rig.gateway->status().interrupted;
        },
        60s))
        << rig.story();
    const MachineStatus now = rig.gateway->status();
    EXPECT_TRUE(now.objects.size() == 2 && now.objects[1].left_out) << "the next gateway knows it, too";
  }
  EXPECT_TRUE(rig.finish()) << rig.story();
  made.filament_mm = rig.filament_mm;
  made.story = rig.story();
  double right = -1, left = -1;
  for (std::size_t i = 1; i < made.track.size(); ++i) {
    const Pose &from = made.track[i - 1], &to = made.track[i];
    const double way = std::abs(to[kX] - from[kX]) + std::abs(to[kY] - from[kY]);
    if (to[kE] <= from[kE] + 1e-6 || way < 1e-4 || std::abs(to[kX]) < 14) continue;
    double& layer = to[kX] > 0 ? right : left;
    if (std::abs(to[kZ] - layer) < 0.1) continue;
    layer = to[kZ];
    ++(to[kX] > 0 ? made.right_layers : made.left_layers);
  }
  return made;
}

const Printed& undisturbed() {
  static const Printed made = print(0s);
  return made;
}

TEST(ExcludeObject, WhatIsNotPlannedOfItIsNotPrintedAndFilamentStaysRight) {
  ASSERT_EQ(undisturbed().right_layers, kLayers) << undisturbed().story;
  const Printed made = print(3s);
  EXPECT_GT(made.right_layers, 0);
  EXPECT_LT(made.right_layers, kLayers - 2) << "what the planner held\n" << made.story;
  // Each square that is not printed takes its filament with it, and no more.
  const double spared_mm = undisturbed().filament_mm - made.filament_mm;
  const double squares = spared_mm / kSquare_mm;
  EXPECT_NEAR(squares, std::round(squares), 0.3) << spared_mm;
  EXPECT_NEAR(squares, kLayers - made.right_layers, 1) << made.story;
  EXPECT_EQ(made.left_layers, undisturbed().left_layers) << "the rest of the print is there";
}

TEST(ExcludeObject, TheNextGatewayGoesOnWithoutItOnTheSamePath) {
  const Printed made = print(3s), again = print(3s, 1500ms);
  EXPECT_EQ(again.right_layers, made.right_layers) << again.story;
  EXPECT_NEAR(again.filament_mm, made.filament_mm, 0.01) << again.story;
}

TEST(ExcludeObject, IsRefusedWhereNoJobRunsAndNamesWhatThereIs) {
  ResumeRig rig;
  rig.job_text = two_squares();
  EXPECT_FALSE(rig.gateway->carry_out(command::ExcludeObject{"left"}));
  ASSERT_TRUE(rig.begin(0.5)) << rig.story();
  const auto refused = rig.gateway->carry_out(command::ExcludeObject{"middle"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().words.english(), "the job has no object middle; it has left, right");
  EXPECT_TRUE(rig.gateway->take_line("EXCLUDE_OBJECT NAME=\"left\"", 1)) << "as a host says it";
  EXPECT_TRUE(rig.gateway->status().objects[0].left_out);
  EXPECT_FALSE(rig.gateway->take_line("M486 S1", 1)) << "where objects begin is the job's to say";
}

}  // namespace
}  // namespace kinebus
