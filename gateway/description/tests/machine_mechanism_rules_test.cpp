// What the joints of a machine file demand of each other, of homing and of the mechanism.

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <utility>
#include <variant>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/tests/machine_text.hpp"

namespace kinebus {
namespace {

TEST(MachineFile, TwoJointsOnOneDriveAreRefused) {
  const auto machine =
      parse_machine(edited("axis = \"B\"\nmm_per_turn = 40", "axis = \"A\"\nmm_per_turn = 40").text, "m");
  ASSERT_FALSE(machine);
  EXPECT_NE(to_string(machine.error())
                .find("joint.tower2.axis: found node 1 axis A; expected a node's axis that no "
                      "other joint has"),
            std::string::npos)
      << to_string(machine.error());
}

TEST(MachineFile, AJointWithTravelMustHaveHoming) {
  std::string text = file_text("delta.toml");
  const std::size_t from = text.find("[joint.tower2.homing]"), to = text.find("[joint.tower2.calibration]");
  text.erase(from, to - from);
  const auto machine = parse_machine(text, "delta.toml");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().front().key, "joint.tower2.homing");
}

TEST(MachineFile, AMirroredMechanismIsRefusedWithTheReason) {
  std::string text = file_text("m1.toml");
  for (const auto& [from, to] : {std::pair{"foot_mm = [-273, -252, 0]", "foot_mm = [-273, -63, 0]"},
                                 {"foot_mm = [-273, 252, 0]", "foot_mm = [-273, 63, 0]"},
                                 {"attachment_mm = [-124, -69, -5]", "attachment_mm = [-124, -128, -5]"},
                                 {"attachment_mm = [-124, 69, -5]", "attachment_mm = [-124, 128, -5]"}})
    text.replace(text.find(from), std::strlen(from), to);
  const auto machine = parse_machine(text, "m1.toml");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().front().key, "kinematics");
  EXPECT_NE(machine.error().front().expected.find("singular"), std::string::npos)
      << to_string(machine.error());
}

TEST(MachineFile, HomingThatDrivesThePlatformIntoTheNozzleIsRefused) {
  // Whatever way the rail counts: it is the platform's motion that is judged.
  MachineDescription d = default_m1();
  auto& g = std::get<M1Geometry>(d.kinematics);
  g.legs[2].rail = {0, 0, -1};
  g.legs[2].foot_mm[2] = 580;
  g.legs[2].connector_mm = -15;
  g.legs[2].carriage_above = true;
  d.joints[2].homing->switch_position = 540;
  auto machine = parse_machine(write_machine(d), "x");
  ASSERT_FALSE(machine);
  ASSERT_EQ(machine.error().size(), 1u) << to_string(machine.error());
  EXPECT_EQ(machine.error().front().key, "joint.tower3.homing.method");
  EXPECT_NE(machine.error().front().expected.find("method 20, "), std::string::npos)
      << to_string(machine.error());
  d.joints[2].homing->method = 20;
  machine = parse_machine(write_machine(d), "x");
  EXPECT_TRUE(machine) << to_string(machine.error());
  // Limit switches, and M5's rails, are judged alike.
  std::string mill = file_text("m5.toml");
  for (std::size_t at; (at = mill.find("method = 20")) != std::string::npos;)
    mill.replace(at, 11, "method = 22");
  // It carries its tool, and the table is below.
  const auto refused = parse_machine(mill, "m5.toml");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().size(), 4u) << to_string(refused.error());
}

TEST(MachineFile, AToolOnThePlatformNeedsToKnowWhereTheTableIs) {
  std::string text = file_text("m5.toml");
  const std::string line = "table_mm = [0, 0, 90] ";
  ASSERT_NE(text.find(line), std::string::npos);
  auto without = text;
  without.replace(without.find(line), line.size(), "# ");
  const auto missing = parse_machine(without, "m5.toml");
  ASSERT_FALSE(missing);
  ASSERT_EQ(missing.error().size(), 1u) << to_string(missing.error());
  EXPECT_EQ(missing.error().front().key, "kinematics.table_mm");
  // A placement that nobody knows is the one error, whatever else is said with it.
  text.replace(text.find("\"platform\""), 10, "\"spindle\"");
  const auto unknown = parse_machine(text, "m5.toml");
  ASSERT_FALSE(unknown);
  ASSERT_EQ(unknown.error().size(), 1u) << to_string(unknown.error());
  EXPECT_EQ(unknown.error().front().key, "kinematics.tool");
}

TEST(MachineFile, CalibrationBendsTheGeometryAndNotTheStatedOne) {
  std::string text = write_machine(default_m1());
  text += "\n[calibration.leg2]\nfoot_mm = [0.5, 0, 0]\nlength_mm = -0.25\n";
  const auto machine = parse_machine(text, "calibrated");
  ASSERT_TRUE(machine) << to_string(machine.error());
  EXPECT_EQ(std::get<M1Geometry>(machine->kinematics).legs[1].length_mm, 991);
  JointVector nominal{}, measured{};
  const Pose pose{10, 20, 30, 0.1, 0, 0};
  ASSERT_TRUE((*make_kinematics(default_m1()))->inverse(Frame::kPart, pose, nominal));
  ASSERT_TRUE((*make_kinematics(*machine))->inverse(Frame::kPart, pose, measured));
  EXPECT_EQ(nominal[0], measured[0]);
  EXPECT_GT(std::abs(nominal[1] - measured[1]), 0.1);
  EXPECT_EQ(nominal[2], measured[2]);
  const auto refused =
      parse_machine("[calibration.leg5]\nlength_mm = 1\n" + write_machine(default_m1()), "x");
  EXPECT_FALSE(refused);
}

TEST(MachineFile, ACorrectionThatNoJointCanFollowIsRefused) {
  MachineDescription d = default_m1();
  d.joints[0].calibration.pitch = 2;
  d.joints[0].calibration.periodic_sine = 0.1;
  const auto refused = parse_machine(write_machine(d), "steep");
  ASSERT_FALSE(refused);
  EXPECT_NE(to_string(refused.error()).find("slope of 0.314159; expected at most 0.05"), std::string::npos)
      << to_string(refused.error());
}

}  // namespace
}  // namespace kinebus
