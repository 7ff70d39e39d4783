// Currents set while the machine is up, a winding measured, one motor moved alone.

#include <gtest/gtest.h>

#include <cmath>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "gateway/machine/tests/machine_rig.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/canopen/node_objects.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class MotorSettingsTest : public ::testing::Test {
 protected:
  struct Currents {
    std::int64_t run = 0, hold = 0;
    friend bool operator==(const Currents&, const Currents&) = default;
  };
  Currents at_node(std::size_t joint) {
    const JointDescription& j = rig.machine.joints[joint];
    for (std::size_t n = 0; n < rig.machine.nodes.size(); ++n)
      if (rig.machine.nodes[n].id == j.node_id) {
        const Node& node = rig.nodes.node(static_cast<int>(n));
        return {node.axis_parameter(slot_of_axes(object::kRunCurrent), j.axis),
                node.axis_parameter(slot_of_axes(object::kHoldCurrent), j.axis)};
      }
    return {};
  }
  bool says(std::string_view part) const { return rig.story().find(part) != std::string::npos; }
  std::string refusal(std::string_view line) {
    const auto done = rig.gateway->text_line(line);
    return done ? "" : std::string(done.error().words.english());
  }
  bool bring_up() {
    return rig.gateway->carry_out(command::BringUp{}) && rig.reach(MachineState::kUnhomed, 30s);
  }

  MachineRig rig;
};

TEST_F(MotorSettingsTest, M906SetsOneJointAndKeepsTheFilesShareForTheHoldCurrent) {
  ASSERT_TRUE(bring_up()) << rig.story();
  ASSERT_EQ(at_node(0), (Currents{2000, 1500}));
  ASSERT_TRUE(rig.gateway->text_line("M906 I1 S1000"));
  rig.run_for(1s);
  EXPECT_EQ(at_node(0), (Currents{1000, 750})) << rig.story();
  EXPECT_EQ(at_node(1), (Currents{2000, 1500})) << "the others' stay";
  EXPECT_TRUE(says("tower1: run current 1000 mA, hold current 750 mA")) << rig.story();
  ASSERT_TRUE(rig.gateway->text_line("M906 I2 H200 ; the hold current alone"));
  ASSERT_TRUE(rig.gateway->text_line("m906 c700 e500 h300"));
  rig.run_for(1s);
  EXPECT_EQ(at_node(1), (Currents{2000, 200}));
  EXPECT_EQ(at_node(4), (Currents{700, 300})) << "C has a motor of its own";
  EXPECT_EQ(at_node(5), (Currents{500, 300}));
  EXPECT_NE(rig.gateway->text_line("M906")->find("tower1 I1: run 1000 mA, hold 750 mA"), std::string::npos)
      << *rig.gateway->text_line("M906");
  EXPECT_DOUBLE_EQ(rig.gateway->status().nodes[0].run_current_a[0], 1.0);
  EXPECT_EQ(rig.gateway->state(), MachineState::kUnhomed) << rig.story();
}

TEST_F(MotorSettingsTest, TheGatewaysOwnChangeIsNoForeignOneAndLastsUntilItIsStartedAnew) {
  ASSERT_TRUE(bring_up()) << rig.story();
  ASSERT_TRUE(rig.gateway->text_line("M906 I1 S1000"));
  rig.run_for(1s);
  const auto asks = parse_frame("601#4041600000000000");
  ASSERT_TRUE(asks);
  rig.stranger_sends(*asks);  // so that the fingerprint is compared again
  rig.run_for(2s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kUnhomed) << rig.story();
  const auto changes = parse_frame("601#2B402102DC050000");  // 1500 mA
  ASSERT_TRUE(changes);
  rig.stranger_sends(*changes);
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(bring_up()) << rig.story();
  EXPECT_EQ(at_node(0), (Currents{1000, 750})) << "what was asked for outlives an alarm";
  rig.gateway = std::make_unique<Gateway>(rig.machine);
  rig.run_for(1s);
  ASSERT_TRUE(bring_up()) << rig.story();
  EXPECT_EQ(at_node(0), (Currents{2000, 1500})) << "a gateway that starts has its file";
}

TEST_F(MotorSettingsTest, InMotionItWaitsForTheEndOfIt) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(
      command::Run{std::make_unique<StringSource>("G1 X40 Y13 F1200\nG1 X0 Y0\n"), "line"}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().line >= 1; }, 30s)) << rig.story();
  const auto told = rig.gateway->text_line("M906 I1 S1100");
  ASSERT_TRUE(told);
  EXPECT_EQ(*told, "echo:the currents are set when the machine stands still");
  rig.run_for(1s);
  ASSERT_EQ(rig.gateway->state(), MachineState::kRunning) << rig.story();
  EXPECT_EQ(at_node(0), (Currents{2000, 1500}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  rig.run_for(1s);
  EXPECT_EQ(at_node(0), (Currents{1100, 825})) << rig.story();
  EXPECT_EQ(rig.gateway->status().counters.sdo_aborts, 0u);
  EXPECT_FALSE(rig.told(AlarmCode::kNodeChanged)) << rig.story();
}

TEST_F(MotorSettingsTest, InAHoldItIsSetAtOnceAndTheJobGoesOn) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(
      command::Run{std::make_unique<StringSource>("G1 X40 Y13 F1200\nG1 X0 Y0\n"), "line"}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().line >= 1; }, 30s)) << rig.story();
  rig.run_for(500ms);
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->text_line("M906 I1 S1100 H400"));
  rig.run_for(1s);
  EXPECT_EQ(at_node(0), (Currents{1100, 400})) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
}

TEST_F(MotorSettingsTest, AResumeRightAfterItLosesNeither) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(
      command::Run{std::make_unique<StringSource>("G1 X40 Y13 F1200\nG1 X0 Y0\n"), "line"}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().line >= 1; }, 30s)) << rig.story();
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
    ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
    ASSERT_TRUE(rig.gateway->text_line(i % 2 == 0 ? "M906 I1 S1100 H400" : "M906 I1 S1200 H500"));
    rig.run_for(BusTime{100'000 * i});
    ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
    rig.run_for(20ms);
  }
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  rig.run_for(1s);
  EXPECT_EQ(at_node(0), (Currents{1200, 500})) << rig.story();
  EXPECT_FALSE(rig.told(AlarmCode::kNodeChanged)) << rig.story();
}

TEST_F(MotorSettingsTest, WhatCannotBeIsRefusedInWords) {
  EXPECT_NE(refusal("M906 I1 S800").find("bring it up first"), std::string::npos);
  ASSERT_TRUE(bring_up()) << rig.story();
  EXPECT_EQ(refusal("M906 X800"),
            "no motor moves X alone on this machine: name a joint by its number, as M906 I1 S800 for tower1");
  EXPECT_EQ(
      refusal("M906 I1 S2500"),
      "tower1: a run current is 50 to 2000 mA; max_current_ma of [joint.tower1] in the machine file says "
      "how much the motor bears");
  EXPECT_NE(refusal("M906 I1 S20").find("50 to 2000"), std::string::npos);
  EXPECT_EQ(refusal("M906 I1 S800 H900"), "tower1: a hold current is 0 to the run current, 800 mA");
  EXPECT_EQ(refusal("M906 I9 S800"), "I is the number of a joint, 1 to 6");
  EXPECT_EQ(refusal("M906 I1.5 S800"), "I is the number of a joint, 1 to 6");
  EXPECT_EQ(refusal("M906 I1"), "M906 I needs the run current S or the hold current H");
  EXPECT_EQ(refusal("M906 S800"), "S and H need the joint I");
  EXPECT_EQ(refusal("M906 C700 I2"), "M906 takes axes or the joint I, not both");
  EXPECT_EQ(refusal("M906 C"), "M906 takes letters with numbers, as M906 X800 H400 or M906 I1 S800");
  EXPECT_NE(refusal("M906 C700 X800"), "") << "all or none";
  rig.run_for(1s);
  EXPECT_EQ(at_node(4), (Currents{1200, 800}));
  EXPECT_FALSE(rig.gateway->carry_out(command::SetMotorCurrents{{{.joint = 6, .run_ma = 500}}}));
  EXPECT_FALSE(rig.gateway->carry_out(command::SetMotorCurrents{{{.joint = 0, .run_ma = std::nan("")}}}));
  EXPECT_FALSE(rig.gateway->carry_out(command::SetMotorCurrents{}));
}

TEST_F(MotorSettingsTest, TheMachineFileMayAllowMore) {
  MachineDescription machine = default_m1();
  machine.joints[0].max_current_ma = 2800;
  const auto again = parse_machine(write_machine(machine), "written");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->joints[0].max_current_ma, 2800u);
  machine.joints[0].max_current_ma = 1900;
  EXPECT_FALSE(parse_machine(write_machine(machine), "below the run current"));
  MachineRig more(*again);
  ASSERT_TRUE(more.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(more.reach(MachineState::kUnhomed, 30s)) << more.story();
  EXPECT_TRUE(more.gateway->text_line("M906 I1 S2800"));
  EXPECT_FALSE(more.gateway->text_line("M906 I1 S2801"));
}

TEST_F(MotorSettingsTest, ANodeWithoutSensorsSaysThatItCannotMeasureAMotor) {
  ASSERT_TRUE(bring_up()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::TuneMotor{0}));
  const auto may = rig.gateway->may(command::kind<command::Home>);
  ASSERT_FALSE(may);
  EXPECT_EQ(may.error().words.english(), "cannot home while a motor is measured (tower1)");
  rig.run_for(3s);
  EXPECT_TRUE(says("tower1: this node measures no currents")) << rig.story();
  EXPECT_TRUE(rig.gateway->may(command::kind<command::Home>));
}

TEST_F(MotorSettingsTest, WhatANodeMeasuresOfAMotorIsToldAndTheFilesValuesCountAgain) {
  ASSERT_TRUE(bring_up()) << rig.story();
  Node& node = rig.nodes.node(0);
  const auto resistance = node.axis_parameter(slot_of_axes(object::kPhaseResistance), 1);
  ASSERT_TRUE(rig.gateway->carry_out(command::TuneMotor{1}));
  ASSERT_TRUE(rig.run_until([&] { return node.take_tune_request(1); }, 1s));
  node.set_feedback(1, {.tune_state = 1});
  EXPECT_TRUE(rig.gateway->status().nodes[0].measures[1]);
  rig.run_for(500ms);
  node.set_motor(1, 1250, 2400, 321);
  node.set_feedback(1, {.tune_state = 2});
  rig.run_for(2s);
  EXPECT_TRUE(says("tower2: measured 1.250 Ohm, 2.400 mH, encoder offset 321")) << rig.story();
  EXPECT_EQ(node.axis_parameter(slot_of_axes(object::kPhaseResistance), 1), resistance);
  EXPECT_EQ(rig.gateway->state(), MachineState::kUnhomed) << rig.story();
  EXPECT_FALSE(rig.gateway->status().nodes[0].measures[1]);
  EXPECT_FALSE(rig.told(AlarmCode::kNodeChanged)) << rig.story();
}

TEST_F(MotorSettingsTest, OneMotorMovesAloneAndTheOthersEndWhereTheyWere) {
  EXPECT_FALSE(rig.gateway->carry_out(command::JogMotor{0, 1}));
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  const JointVector before = rig.joints();
  ASSERT_TRUE(rig.gateway->carry_out(command::JogMotor{.joint = 0, .distance = 2, .speed_per_s = 4}));
  const BusTime begun = rig.now;
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  EXPECT_NEAR(to_seconds(rig.now - begun), 0.5, 0.4) << "as fast as the joint was asked to go";
  const JointVector after = rig.joints();
  EXPECT_NEAR(after[0], before[0] + 2, 0.005);
  for (std::size_t j = 1; j < 6; ++j) EXPECT_NEAR(after[j], before[j], 0.005) << j;
  EXPECT_FALSE(rig.gateway->carry_out(command::JogMotor{0, 25}));
  EXPECT_FALSE(rig.gateway->carry_out(command::JogMotor{0, 0}));
  EXPECT_FALSE(rig.gateway->carry_out(command::JogMotor{9, 1}));
  EXPECT_FALSE(rig.gateway->carry_out(command::JogMotor{0, std::nan("")}));
}

TEST_F(MotorSettingsTest, StageTemperaturesAndCountsAreInTheStatus) {
  ASSERT_TRUE(bring_up()) << rig.story();
  rig.nodes.node(0).set_feedback(1, {.temperature_dc = 412, .current_ma = 870});
  EXPECT_FALSE(rig.gateway->status().nodes[0].stage_celsius[1]) << "not read yet";
  for (int i = 0; i < 60; ++i) {
    rig.gateway->watch_currents();
    rig.run_for(100ms);
  }
  const MachineStatus s = rig.gateway->status();
  ASSERT_TRUE(s.nodes[0].stage_celsius[1]);
  EXPECT_DOUBLE_EQ(*s.nodes[0].stage_celsius[1], 41.2);
  ASSERT_TRUE(s.nodes[0].current_a[1]);
  EXPECT_DOUBLE_EQ(*s.nodes[0].current_a[1], 0.87);
  EXPECT_FALSE(s.nodes[1].stage_celsius[0]) << "a node without sensors has none";
}

TEST(MotorLetters, AnAxisWithAMotorOfItsOwnIsNamedByItsLetter) {
  const auto machine = load_machine(machines_folder() / "cartesian.toml");
  ASSERT_TRUE(machine);
  MachineRig rig(*machine);
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
  const double run = rig.gateway->status().nodes[0].run_current_a[0] * 1000;
  ASSERT_TRUE(rig.gateway->text_line("M906 X" + std::to_string(run / 2) + " I0 E300"));
  rig.run_for(1s);
  EXPECT_DOUBLE_EQ(rig.gateway->status().nodes[0].run_current_a[0] * 2000, run) << rig.story();
  const auto belts = load_machine(machines_folder() / "corexy.toml");
  ASSERT_TRUE(belts);
  MachineRig corexy(*belts);
  ASSERT_TRUE(corexy.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(corexy.reach(MachineState::kUnhomed, 30s)) << corexy.story();
  EXPECT_FALSE(corexy.gateway->text_line("M906 Y400")) << "both belts move Y";
  EXPECT_TRUE(corexy.gateway->text_line("M906 Z400"))
      << corexy.gateway->text_line("M906 Z400").error().words.english();
}

}  // namespace
}  // namespace kinebus
