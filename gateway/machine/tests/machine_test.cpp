// The whole machine from its gateway's side: bring-up, homing, moves, jobs, hold, cancel, stop.

#include <gtest/gtest.h>

#include <cmath>

#include "gateway/bodies/tests/legs_below.hpp"
#include "gateway/machine/tests/machine_rig.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

TEST(Machine, BringUpEndsUnhomedWithDrivesEnabledAndClocksSynchronised) {
  MachineRig rig;
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story() << rig.gateway->status().doing;
  const MachineStatus status = rig.gateway->status();
  ASSERT_EQ(status.nodes.size(), 3u);
  for (const NodeStatus& node : status.nodes) {
    EXPECT_TRUE(node.present);
    EXPECT_TRUE(node.synchronised);
    for (const std::uint16_t word : node.statusword) EXPECT_EQ(word & 0x6F, 0x27) << std::hex << word;
  }
  EXPECT_FALSE(status.positions_known);
}

TEST(Machine, CurrentsAreThoseThatTheNodesMeasureAndReadOnlyForSomebody) {
  MachineRig rig;
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
  int requests = 0;
  rig.on_frame = [&](BusTime, const CanFrame& frame) {
    requests += frame.id > cob_id::kSdoRequest && frame.id <= cob_id::kSdoRequest + 3 ? 1 : 0;
  };
  rig.run_for(2s);
  EXPECT_EQ(requests, 0);
  for (const NodeStatus& node : rig.gateway->status().nodes) EXPECT_FALSE(node.current_a[0]);

  for (int i = 0; i < 10; ++i) {
    rig.gateway->watch_currents();
    rig.run_for(100ms);
  }
  EXPECT_NEAR(requests, 10, 2);
  // A node without sensors has what it is told to hold.
  EXPECT_EQ(rig.gateway->status().nodes[0].current_a[1], 1.5);
  EXPECT_EQ(rig.gateway->status().nodes[2].current_a[1], 0.4);
  rig.nodes.node(0).set_feedback(1, {.current_ma = 1234});
  rig.gateway->watch_currents();
  rig.run_for(1s);
  EXPECT_EQ(rig.gateway->status().nodes[0].current_a[1], 1.234);
  // Nobody has looked for long: what was read then is no current of now.
  rig.run_for(6s);
  EXPECT_FALSE(rig.gateway->status().nodes[0].current_a[1]);
}

TEST(Machine, HomingTakesAllCarriagesToTheirSwitches) {
  MachineRig rig;
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Home{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 120s)) << rig.story() << rig.gateway->status().doing;
  const JointVector joints = rig.joints();
  const JointVector told = rig.gateway->status().joints;
  for (std::size_t tower = 0; tower < 4; ++tower) {
    EXPECT_NEAR(joints[tower], rig.machine.joints[tower].homing->switch_position, 0.1);
    EXPECT_NEAR(told[tower], joints[tower], 0.002);
  }
  EXPECT_TRUE(rig.gateway->status().positions_known);
}

TEST(Machine, BedReferenceStandsTheNozzleOverTheTablesCentre) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  const MachineStatus status = rig.gateway->status();
  EXPECT_NEAR(status.machine_pose[kX], 0, 1e-3);
  EXPECT_NEAR(status.machine_pose[kY], 0, 1e-3);
  EXPECT_NEAR(status.machine_pose[kZ], 20, 1e-3);
  const JointVector joints = rig.joints();
  for (std::size_t tower = 0; tower < 4; ++tower) EXPECT_NEAR(joints[tower], status.joints[tower], 0.002);
}

TEST(Machine, JobMovesTheToolToItsEnd) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.run_job("G21 G90\nG1 X20 Y10 Z15 F6000\nG1 X-20 F3000\nG1 Y-10 A5\n")) << rig.story();
  const MachineStatus status = rig.gateway->status();
  EXPECT_NEAR(status.machine_pose[kX], -20, 2e-3) << rig.story();
  EXPECT_NEAR(status.machine_pose[kY], -10, 2e-3);
  EXPECT_NEAR(status.machine_pose[kZ], 15, 2e-3);
  EXPECT_NEAR(status.machine_pose[kA] * 57.29577951, 5, 2e-3);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

TEST(Machine, JobWithAnErrorMovesNothing) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  const JointVector before = rig.joints();
  ASSERT_TRUE(rig.run_job("G1 X20 F6000\nG1 X400\n"));
  EXPECT_TRUE(rig.told(MachineEvent::Kind::kProblem));
  const JointVector after = rig.joints();
  for (std::size_t joint = 0; joint < 6; ++joint) EXPECT_EQ(before[joint], after[joint]);
}

TEST(Machine, HoldStandsStillAndResumeFinishesTheJob) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(
      rig.gateway->carry_out(command::Run{std::make_unique<StringSource>("G1 X60 F1200\nG1 X0\n"), "line"}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().machine_pose[kX] > 20; }, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s)) << rig.story();
  rig.run_for(200ms);
  const JointVector still = rig.joints();
  rig.run_for(2s);
  EXPECT_EQ(rig.joints(), still);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 0, 2e-3);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

TEST(Machine, CancelDropsTheJobAndTheNextOneStartsFromThere) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(
      rig.gateway->carry_out(command::Run{std::make_unique<StringSource>("G1 X60 F1200\nG1 X0\n"), "line"}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().machine_pose[kX] > 20; }, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s)) << rig.story();
  const MachineStatus status = rig.gateway->status();
  EXPECT_GT(status.machine_pose[kX], 20);
  EXPECT_LT(status.machine_pose[kX], 30);
  const JointVector joints = rig.joints();
  for (std::size_t tower = 0; tower < 4; ++tower) EXPECT_NEAR(joints[tower], status.joints[tower], 0.001);
  ASSERT_TRUE(rig.run_job("G1 X-10 F3000\n")) << rig.story();
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], -10, 2e-3);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

TEST(Machine, StopIsLatchedAndAfterClearTheJobGoesOn) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(
      rig.gateway->carry_out(command::Run{std::make_unique<StringSource>("G1 X60 F1200\nG1 X0\n"), "line"}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().machine_pose[kX] > 20; }, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s)) << rig.story();
  EXPECT_FALSE(rig.gateway->carry_out(command::Resume{}));
  const JointVector still = rig.joints();
  rig.run_for(1s);
  EXPECT_EQ(rig.joints(), still);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 0, 2e-3);
}

TEST(Machine, WaitForTemperatureTakesVirtualTime) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  const BusTime begin = rig.now;
  ASSERT_TRUE(rig.run_job("M109 S200\nG1 X5 F3000\n", 600s)) << rig.story();
  EXPECT_GT(to_seconds(rig.now - begin), 10);
  EXPECT_NEAR(rig.gateway->status().heater(kFirstHotend).actual_celsius, 200, 3);
}

TEST(Machine, PauseInTheJobWaitsForResume) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(
      command::Run{std::make_unique<StringSource>("G1 X5 F3000\nM0\nG1 X10\n"), "pause"}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 30s)) << rig.story();
  rig.run_for(1s);
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 5, 2e-3);
  const auto moved = rig.gateway->take_line("G1 X1", 1);
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().words, "cannot move while the machine is held");
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 10, 2e-3);
}

TEST(Machine, FeedOverrideSlowsTheJobDown) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetFeedOverride{0.5}));
  const BusTime begin = rig.now;
  ASSERT_TRUE(rig.run_job("G1 X60 F1200\n")) << rig.story();
  EXPECT_GT(to_seconds(rig.now - begin), 5.9);
  EXPECT_LT(to_seconds(rig.now - begin), 8);
  EXPECT_EQ(rig.gateway->status().feed_override, 1) << "the next job's";
}

TEST(Machine, JogMovesRelativeAndIsRefusedBeyondTheWorkspace) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Jog{.delta = {5, -3, 0, 0, 0, 0}, .speed_per_s = 20}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 5, 2e-3);
  EXPECT_NEAR(rig.gateway->status().machine_pose[kY], -3, 2e-3);
  const auto beyond = rig.gateway->carry_out(command::Jog{.delta = {500, 0, 0, 0, 0, 0}});
  ASSERT_FALSE(beyond);
  EXPECT_TRUE(beyond.error().words.starts_with("X is 355.0")) << beyond.error().words;
  EXPECT_FALSE(rig.gateway->carry_out(command::Jog{.delta = {0, 0, 0, 0, 0, 5}})) << "cold extrusion";
}

TEST(Machine, MovesByHandThatBringTwoBodiesTogetherAreRefusedWithTheirNames) {
  MachineDescription d = legs_below();
  d.bodies->fixed.push_back({"clamp", {131, -15, 1240}, {160, 15, 1299}});
  MachineRig rig(d);
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  const auto jog = rig.gateway->carry_out(command::Jog{.delta = {-60, 0, 0, 0, 0, 0}, .speed_per_s = 100});
  ASSERT_FALSE(jog);
  EXPECT_TRUE(jog.error().words.starts_with("table and clamp would")) << jog.error().words;
  ASSERT_TRUE(rig.gateway->carry_out(command::Jog{.delta = {-20, 0, 0, 0, 0, 0}, .speed_per_s = 100}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
}

TEST(Machine, TheWayToTheBedReferenceIsRefusedWhereTwoBodiesMeetOnIt) {
  MachineDescription d = legs_below();
  // Beside the table where it waits; the machine comes in under it.
  d.bodies->fixed.push_back({"ledge", {105, -15, 1200}, {160, 15, 1262}});
  MachineRig rig(d);
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  const auto jog = [&](const Pose& delta) {
    const auto done = rig.gateway->carry_out(command::Jog{.delta = delta, .speed_per_s = 200});
    EXPECT_TRUE(done) << done.error().words;
    EXPECT_TRUE(rig.reach(MachineState::kReady, 20s)) << rig.story();
  };
  jog({0, 0, 100, 0, 0, 0});
  jog({-40, 0, 0, 0, 0, 0});
  const auto reference = rig.gateway->carry_out(command::GoToReference{});
  ASSERT_FALSE(reference);
  EXPECT_TRUE(reference.error().words.starts_with("table and ledge would")) << reference.error().words;
  // A job goes there first: it is not begun.
  EXPECT_TRUE(rig.run_job("G1 Z30 F6000\n")) << rig.story();
  EXPECT_NE(rig.story().find("the job was not begun: on the way to the bed reference table and ledge would"),
            std::string::npos)
      << rig.story();
  jog({40, 0, 0, 0, 0, 0});
  EXPECT_TRUE(rig.gateway->carry_out(command::GoToReference{}));
  EXPECT_TRUE(rig.reach(MachineState::kReady, 20s));
}

TEST(Machine, WhatAJobHasPrintedStandsInTheWayUntilTheTableIsSaidToBeEmpty) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  std::string job = "M83\nG1 X-5 Y0 Z0.5 F12000\n";
  for (int i = 1; i <= 80; ++i)
    job += "G1 Z" + std::to_string(0.5 * i) + "\nG1 X" + (i % 2 == 0 ? "-5" : "5") + " E0.5\n";
  job += "G1 Z60\nG1 X0 Y60\nG1 Z10\n";
  ASSERT_TRUE(rig.run_job(job)) << rig.story();
  const Pose through{0, -120, 0, 0, 0, 0};
  const auto jog = rig.gateway->carry_out(command::Jog{.delta = through, .speed_per_s = 200});
  ASSERT_FALSE(jog);
  const std::string touches =
      "nozzle and part on the table would touch: what was printed is taken to stand on the table until the "
      "next job begins, or the machine is homed with no job interrupted";
  EXPECT_EQ(jog.error().words, touches);
  const auto reference = rig.gateway->carry_out(command::GoToReference{});
  ASSERT_FALSE(reference) << "20 mm above the table's middle, where 40 mm stand";
  EXPECT_EQ(reference.error().words, touches);
  // Away from it, and over it.
  for (const Pose& delta : {Pose{0, 0, 40, 0, 0, 0}, through}) {
    const auto done = rig.gateway->carry_out(command::Jog{.delta = delta, .speed_per_s = 200});
    ASSERT_TRUE(done) << done.error().words;
    ASSERT_TRUE(rig.reach(MachineState::kReady, 20s)) << rig.story();
  }
  // The next job is begun on an empty table.
  ASSERT_TRUE(rig.run_job("G1 Z10 F12000\nG1 Y-60\n")) << rig.story();
  EXPECT_TRUE(rig.gateway->carry_out(command::GoToReference{}));
  EXPECT_TRUE(rig.reach(MachineState::kReady, 20s)) << rig.story();
}

TEST(Machine, TextSessionAnswersItsQueries) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  EXPECT_EQ(rig.gateway->text_line("M114")->substr(0, 25), "X:0.000 Y:0.000 Z:20.000 ")
      << *rig.gateway->text_line("M114");
  EXPECT_EQ(rig.gateway->text_line("M105")->substr(0, 13), "T:23.00 /0.00");
  EXPECT_NE(rig.gateway->text_line("M115")->find("FIRMWARE_NAME:Kinebus"), std::string::npos);
  EXPECT_NE(rig.gateway->text_line("M119")->find("tower1: open"), std::string::npos);
  ASSERT_TRUE(rig.gateway->text_line("M104 S60"));
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 60);
  EXPECT_FALSE(rig.gateway->text_line("M104 S900"));
  EXPECT_FALSE(rig.gateway->text_line("G1 X10"));
  ASSERT_TRUE(rig.gateway->text_line("M112"));
  EXPECT_TRUE(rig.reach(MachineState::kStopped, 2s));
}

TEST(Machine, PlannedPoseIsWhereTheToolIs) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(
      command::Run{std::make_unique<StringSource>("G1 X40 Y20 F3000\nG1 X0\n"), "line"}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().machine_pose[kX] > 5; }, 30s));
  for (int i = 0; i < 20; ++i) {
    rig.run_for(37ms);
    const auto planned = rig.gateway->planned_pose(rig.gateway->path_time(rig.now));
    ASSERT_TRUE(planned);
    const JointVector joints = rig.joints();
    Pose pose = planned->pose;
    const auto kinematics = make_kinematics(rig.machine);
    ASSERT_TRUE((*kinematics)->forward(planned->frame, joints, pose));
    for (const int axis : {kX, kY, kZ}) EXPECT_NEAR(pose[axis], planned->pose[axis], 1.5e-3) << axis;
  }
}

TEST(Machine, MotorsOffLosesPositions) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::MotorsOff{}));
  EXPECT_EQ(rig.gateway->state(), MachineState::kOff);
  EXPECT_FALSE(rig.gateway->carry_out(command::Run{std::make_unique<StringSource>("G1 X1 F600\n"), "x"}));
}

TEST(Calibration, HomesAndRunsWithEveryCorrectionInThePath) {
  MachineDescription description = default_m1();
  for (std::size_t i = 0; i < 4; ++i) {
    JointCalibration& c = description.joints[i].calibration;
    c.scale = 1e-3;
    c.offset = 0.2;
    c.backlash = 0.08;
    c.pitch = 40;
    c.periodic_sine = 0.01;
    c.table_start = 40;
    c.table_step = 100;
    c.table = {0, 0.02, -0.01, 0.03, 0, 0.01};
  }
  MachineRig rig(description, [](auto&) {});
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Run{
      std::make_unique<StringSource>("G1 X40 Y20 Z30 F3000\nG1 X-40 Z60\nG1 Y-30\nG1 X0 Y0 Z30\n"),
      "back and forth"}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_NEAR(rig.gateway->status().pose[kZ], 30, 2e-3);
  EXPECT_NEAR(rig.gateway->status().pose[kX], 0, 2e-3);
  // And once more from where it stands: no mismatch at the start, whatever side of the gaps the motors are
  // on.
  ASSERT_TRUE(rig.gateway->carry_out(
      command::Run{std::make_unique<StringSource>("G1 X10 Y10 F3000\nG1 X0\n"), "again"}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_EQ(rig.gateway->status().counters.underruns, 0u);
}

}  // namespace
}  // namespace kinebus
