// What each command does to the state of the machine, and what is told of it, word for word.

#include <gtest/gtest.h>

#include <algorithm>

#include "gateway/machine/tests/hand_rig.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class States : public HandRig {};

TEST_F(States, AJobFromItsCheckToItsEnd) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::SetFeedOverride{0.5}));
  ASSERT_TRUE(runs_to(kLine, 20)) << rig.story();
  MachineStatus s = status();
  EXPECT_EQ(s.job, "part");
  EXPECT_EQ(s.line, 1U);
  EXPECT_FALSE(s.interrupted);
  EXPECT_EQ(s.feed_override, 0.5);
  EXPECT_NEAR(s.progress, 20. / 120, 0.02);
  EXPECT_NEAR(s.remaining_s, 100. / 20 / 0.5, 0.5) << "at the override's pace";
  EXPECT_GT(s.elapsed_s, 20. / 20 / 0.5);
  EXPECT_LT(s.elapsed_s, 20. / 20 / 0.5 + 2);
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  EXPECT_EQ(told(),
            "= checking the job\n= running\n. job done: part\n- the feed is as programmed again\n= ready\n");
  s = status();
  EXPECT_EQ(s.job, "");
  EXPECT_EQ(s.feed_override, 1);
  EXPECT_EQ(s.progress, 0);
  EXPECT_EQ(s.elapsed_s, 0);
  EXPECT_NEAR(x(), 0, 2e-3);
  ASSERT_TRUE(asks(command::Jog{.delta = {5, 0, 0, 0, 0, 0}, .speed_per_s = 20}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  EXPECT_NEAR(x(), 5, 2e-3) << "by hand after it";
}

TEST_F(States, AMoveByHand) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Jog{.delta = {10, 0, 0, 0, 0, 0}, .speed_per_s = 10}));
  EXPECT_EQ(state(), MachineState::kMoving);
  rig.run_for(500ms);
  EXPECT_NEAR(status().elapsed_s, 0.5, 0.02);
  EXPECT_EQ(status().progress, 0) << "nobody knows";
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 2s));
  EXPECT_TRUE(rests());
  EXPECT_LT(x(), 9);
  ASSERT_TRUE(asks(command::Resume{}));
  EXPECT_EQ(state(), MachineState::kMoving) << "what was held";
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  EXPECT_NEAR(x(), 10, 2e-3);
  EXPECT_EQ(told(), "= moving\n= holding\n= held\n= moving\n. move done\n= ready\n");
}

TEST_F(States, ACancelFromEveryState) {
  ASSERT_TRUE(ready());
  EXPECT_EQ(why_not(command::Cancel{}), "there is no interrupted job to cancel");
  ASSERT_TRUE(runs(kLine));
  ASSERT_EQ(state(), MachineState::kChecking);
  ASSERT_TRUE(asks(command::Cancel{}));
  EXPECT_EQ(told(), "= checking the job\n= ready\n");
  EXPECT_EQ(status().job, "");
  rig.run_for(2s);
  EXPECT_EQ(state(), MachineState::kReady) << "nothing begins";

  ASSERT_TRUE(asks(command::SetFeedOverride{0.5}));
  ASSERT_TRUE(runs_to(kLine, 20));
  ASSERT_TRUE(asks(command::Cancel{}));
  EXPECT_EQ(state(), MachineState::kCancelling);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 2s));
  EXPECT_EQ(told(),
            "= checking the job\n= running\n= cancelling\n- the feed is as programmed again\n"
            "- cancelled: positions are known\n= ready\n");
  EXPECT_TRUE(rests());
  EXPECT_LT(x(), 30);
  EXPECT_EQ(status().feed_override, 1);
  EXPECT_EQ(why_not(command::Resume{}), "there is no interrupted job to resume");

  ASSERT_TRUE(runs_to(kLine, 35));
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(asks(command::Cancel{})) << "in the ramp of the hold";
  ASSERT_TRUE(rig.reach(MachineState::kReady, 2s));
  ASSERT_TRUE(runs_to(kLine, 35));
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 2s));
  told();
  ASSERT_TRUE(asks(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 2s));
  EXPECT_EQ(told(), "= cancelling\n- cancelled: positions are known\n= ready\n");
  EXPECT_EQ(status().job, "");
}

TEST_F(States, AnInterruptedJobIsCancelledWhereverTheMachineIs) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  ASSERT_TRUE(asks(command::SetFeedOverride{0.7}));
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  ASSERT_TRUE(asks(command::MotorsOff{}));
  EXPECT_EQ(told(), "= checking the job\n= running\n- stop by command\n= stopping\n= stopped\n= off\n");
  EXPECT_TRUE(status().interrupted);
  EXPECT_EQ(status().job, "part");
  EXPECT_FALSE(status().positions_known);
  ASSERT_TRUE(asks(command::Cancel{}));
  EXPECT_EQ(state(), MachineState::kOff);
  EXPECT_FALSE(status().interrupted);
  EXPECT_EQ(status().job, "");
  EXPECT_EQ(told(), "- the feed is as programmed again\n");
  EXPECT_EQ(why_not(command::Resume{}), "there is no interrupted job to resume");
}

TEST_F(States, HeatIsOffAfterACancelWhereTheFileSaysSo) {
  MachineDescription machine = with_devices(default_m1());
  machine.thermal.on_cancel = ThermalDescription::After::kOff;
  use(machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  ASSERT_TRUE(asks(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 2s));
  EXPECT_EQ(told().find("heaters"), std::string::npos) << "they were";
  ASSERT_TRUE(runs_to("M104 S200\nM140 S60\n" + kLine, 35));
  told();
  ASSERT_TRUE(asks(command::Cancel{}));
  EXPECT_EQ(told(), "- the heaters are off: the job was cancelled\n= cancelling\n");
  EXPECT_EQ(hand.hotend.target, 0);
  EXPECT_EQ(hand.bed.target, 0);
}

TEST_F(States, HeatStaysAfterACancelElse) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to("M104 S200\nM140 S60\n" + kLine, 20));
  ASSERT_TRUE(asks(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 2s));
  EXPECT_EQ(hand.hotend.target, 200);
  EXPECT_EQ(hand.bed.target, 60);
}

TEST_F(States, WhatMayNotBeGivenNowIsRefusedWithTheWayOut) {
  EXPECT_EQ(why_not(command::Jog{}), "cannot jog while the machine is off: bring it up first");
  EXPECT_EQ(why_not(command::Clear{}), "cannot clear while the machine is off: bring it up first");
  ASSERT_TRUE(asks(command::BringUp{}));
  EXPECT_EQ(why_not(command::BringUp{}), "cannot bring up while the machine is bring-up");
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s));
  EXPECT_EQ(why_not(command::Run{}), "cannot run a job while the machine is not homed: home it first");
  ASSERT_TRUE(asks(command::Home{}));
  EXPECT_EQ(why_not(command::Home{}), "cannot home while the machine is homing");
  ASSERT_TRUE(rig.reach(MachineState::kReady, 120s));
  ASSERT_TRUE(asks(command::Stop{}));
  EXPECT_EQ(why_not(command::Home{}), "cannot home while the machine is stopping");
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  EXPECT_EQ(why_not(command::Home{}), "cannot home while the machine is stopped: clear first");
}

TEST_F(States, TheWayToTheReferenceTakesNoJog) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Jog{.delta = {30, 0, 0, 0, 0, 0}, .speed_per_s = 100}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  ASSERT_TRUE(asks(command::GoToReference{}));
  rig.run_for(100ms);
  EXPECT_EQ(why_not(command::Jog{.delta = {1, 0, 0, 0, 0, 0}}), "cannot jog while the machine is moving");
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  EXPECT_NEAR(x(), 0, 2e-3);
}

TEST_F(States, AJogIsHeldOnAndAnotherIsRefused) {
  ASSERT_TRUE(ready());
  const command::Jog held{.delta = {1000, 0, 0, 0, 0, 0}, .speed_per_s = 20, .while_held = true};
  ASSERT_TRUE(asks(command::Jog{.delta = {}, .while_held = true})) << "let go too late";
  EXPECT_EQ(state(), MachineState::kReady);
  ASSERT_TRUE(asks(held));
  rig.run_for(100ms);
  EXPECT_EQ(why_not(command::Jog{.delta = {0, 5, 0, 0, 0, 0}, .while_held = true}),
            "another jog is under way");
  EXPECT_EQ(why_not(command::Jog{.delta = {1, 0, 0, 0, 0, 0}}), "another jog is under way");
  ASSERT_TRUE(asks(command::Jog{.delta = {}, .while_held = true}));
  EXPECT_EQ(state(), MachineState::kCancelling);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 2s));
  EXPECT_EQ(told(), "= moving\n= cancelling\n. move done\n= ready\n");
  ASSERT_TRUE(asks(command::Jog{.delta = {1, 0, 0, 0, 0, 0}, .speed_per_s = 5}));
  EXPECT_EQ(why_not(held), "another jog is under way");
}

TEST_F(States, AJobThatHasErrorsIsNotBegun) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs("G1 X20 F6000\nG1 X400\nG1 X0\nG1 X-400\n"));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 2s));
  const std::string text = told();
  EXPECT_EQ(std::count(text.begin(), text.end(), '?'), 2) << text;
  EXPECT_NE(
      text.find(". the job was not begun: it has 2 errors -> correct the lines named, then run it again"),
      std::string::npos)
      << text;
  EXPECT_EQ(status().job, "");
  EXPECT_FALSE(status().interrupted);
  EXPECT_NEAR(x(), 0, 2e-3);
}

TEST_F(States, AMotorIsJoggedAloneOnlyAsFarAndAsFastAsIsAsked) {
  ASSERT_TRUE(ready());
  const JointVector before = status().joints;
  EXPECT_EQ(why_not(command::JogMotor{.joint = 0, .distance = 20.01}),
            "one motor alone goes at most 20 mm or 30 degrees: the others hold the tool");
  EXPECT_EQ(why_not(command::JogMotor{.joint = 6, .distance = 1}), "there is no joint 7: they are 1 to 6");
  const BusTime from = rig.now;
  ASSERT_TRUE(asks(command::JogMotor{.joint = 0, .distance = 15}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  EXPECT_NEAR(to_seconds(rig.now - from), 3, 0.4) << "5 mm/s";
  for (std::size_t joint = 0; joint < 6; ++joint)
    EXPECT_NEAR(status().joints[joint], before[joint] + (joint == 0 ? 15 : 0), 0.01) << joint;
  const BusTime again = rig.now;
  ASSERT_TRUE(asks(command::JogMotor{.joint = 0, .distance = -15, .speed_per_s = 20}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  EXPECT_NEAR(to_seconds(rig.now - again), 15 / 20., 0.4);
  EXPECT_NEAR(status().joints[0], before[0], 0.01);
}

TEST_F(States, WorkOffsetsAreSetWhereTheToolStandsWhenItIsKnown) {
  EXPECT_EQ(why_not(command::SetWorkOffset{.system = 1, .here = true}),
            "cannot set a work offset while the machine is off: home it first");
  EXPECT_EQ(why_not(command::SetWorkOffset{.system = 1, .offset = {1, 2, 3, 0, 0, 0}}), "");
  EXPECT_EQ(status().work_offset[kY], 2);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Jog{.delta = {12, 0, 0, 0, 0, 0}, .speed_per_s = 100}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  ASSERT_TRUE(asks(command::SetWorkOffset{.system = 1, .here = true}));
  EXPECT_NEAR(status().work_offset[kX], 12, 2e-3);
}

TEST_F(States, ASecondJobEndsOneThatWasInterrupted) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  ASSERT_TRUE(asks(command::SetFeedOverride{0.8}));
  rig.gateway->on_bus_failure(rig.now, "bus-off");
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s));
  EXPECT_EQ(status().job, "part");
  EXPECT_TRUE(status().interrupted);
  EXPECT_NEAR(status().progress, 20. / 120, 0.03);
  told();
  ASSERT_TRUE(asks(command::Run{std::make_unique<StringSource>("G1 X5 F1200\n"), "other"}));
  ASSERT_TRUE(rig.run_until([&] { return state() == MachineState::kRunning && x() < 4; }, 20s));
  EXPECT_EQ(status().feed_override, 1) << "that was the other's";
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_EQ(told(),
            "- the feed is as programmed again\n= checking the job\n= running\n. job done: other\n= ready\n");
  EXPECT_EQ(why_not(command::Resume{}), "there is no interrupted job to resume");
}

TEST_F(States, JogsThatWaitAreAtMostSixteen) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Jog{.delta = {5, 0, 0, 0, 0, 0}, .speed_per_s = 5}));
  for (int i = 0; i < 16; ++i) {
    const double sense = i % 2 == 0 ? -1 : 1;
    ASSERT_TRUE(asks(command::Jog{.delta = {sense, 0, 0, 0, 0, 0}, .speed_per_s = 50})) << i;
  }
  EXPECT_EQ(why_not(command::Jog{.delta = {-1, 0, 0, 0, 0, 0}, .speed_per_s = 50}),
            "16 moves are waiting already");
  EXPECT_EQ(why_not(command::Jog{.delta = {1, 0, 0, 0, 0, 0}, .speed_per_s = 50}), "") << "goes on alike";
  EXPECT_EQ(why_not(command::Jog{.delta = {1, 0, 0, 0, 0, 0}, .speed_per_s = 40}),
            "16 moves are waiting already")
      << "not so fast";
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s));
  EXPECT_NEAR(x(), 6, 2e-3);
}

TEST_F(States, AJogsOwnPaceIsThatOfWhatMoves) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 200}));
  struct Case {
    Pose delta;
    double seconds;
  };
  for (const Case& c : {Case{{20, 0, 0, 0, 0, 0}, 20 / 20.}, Case{{0, 0, 0, 0.12, 0, 0}, 0.12 / 0.3},
                        Case{{0, 0, 0, 0, 0, 6}, 6 / 3.}}) {
    const BusTime from = rig.now;
    ASSERT_TRUE(asks(command::Jog{.delta = c.delta}));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 20s));
    EXPECT_NEAR(to_seconds(rig.now - from), c.seconds, 0.35);
  }
}

TEST_F(States, AJogThatLeavesTheWorkspaceIsRefusedByHowFarAndOneThatIsHeldEndsAtItsEdge) {
  ASSERT_TRUE(ready());
  const std::string beyond = why_not(command::Jog{.delta = {400, 0, 0, 0, 0, 0}});
  EXPECT_EQ(beyond, "X is 250.000 mm outside the workspace");
  const command::Jog held{.delta = {400, 0, 0, 0, 0, 0}, .speed_per_s = 300, .while_held = true};
  ASSERT_TRUE(asks(held));
  for (; state() == MachineState::kMoving; rig.run_for(50ms)) static_cast<void>(asks(held));
  EXPECT_GT(x(), 140);
  EXPECT_LT(x(), 150.001);
  EXPECT_EQ(why_not(held), why_not(command::Jog{.delta = {400, 0, 0, 0, 0, 0}})) << "no way is left";
}

TEST_F(States, AMachineOfWhichNobodyKnowsWhatIsSolid) {
  MachineDescription machine = with_devices(default_m1());
  machine.bodies.reset();
  use(machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  ASSERT_TRUE(asks(command::MotorsOff{}));
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s));
  ASSERT_TRUE(asks(command::Home{}));
  EXPECT_FALSE(status().positions_known) << "on its way";
  ASSERT_TRUE(rig.reach(MachineState::kReady, 120s));
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_NEAR(x(), 0, 2e-3);
}

TEST_F(States, WhatTheNodesSayIsInTheStatus) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::SetWorkOffset{.system = 1, .offset = {1, 2, 3, 0, 0, 0}}));
  std::uint64_t sent = 0;
  rig.on_frame = [&](BusTime, const CanFrame& frame) {
    for (std::uint8_t node = 1; node <= 3; ++node)
      sent += frame.id == cob_id::rpdo(3, node) || frame.id == cob_id::rpdo(4, node) ? 1 : 0;
  };
  const std::uint64_t before = status().counters.segments_sent;
  ASSERT_TRUE(rig.run_job("G1 X10 F1200\n"));
  EXPECT_EQ(status().counters.segments_sent - before, sent);
  EXPECT_GT(hand.served, 100);
  const MachineStatus s = status();
  EXPECT_EQ(s.now, rig.now);
  EXPECT_EQ(s.work_system, 1U);
  EXPECT_EQ(s.doing.english(), "ready");
  EXPECT_FALSE(s.measured_pose) << "no encoder is there";
  ASSERT_TRUE(rig.gateway->take_line("G55", 1));
  EXPECT_EQ(status().work_system, 2U);
  EXPECT_EQ(s.rate, 0);
  EXPECT_GT(s.path_time_s, 0.5);
  EXPECT_GT(s.bus_load, 0.001);
  EXPECT_GE(s.bus_load_peak, s.bus_load);
  EXPECT_EQ(s.joint_count, 6);
  EXPECT_GT(s.counters.frames_sent, 100U);
  EXPECT_GT(s.counters.frames_received, 100U);
  EXPECT_GT(s.counters.segments_sent, 10U);
  std::uint64_t records = 0;
  for (const NodeStatus& node : s.nodes) {
    EXPECT_TRUE(node.present && node.synchronised && node.has_axes);
    EXPECT_EQ(node.nmt_state, 5);
    EXPECT_EQ(node.queue_records, 0);
    EXPECT_FALSE(node.stopped);
    EXPECT_GT(node.records_sent, 10U);
    EXPECT_LT(node.sync_error_us, 100);
    EXPECT_EQ(node.emergencies, 0U);
    records += node.records_sent;
  }
  EXPECT_LE(records, s.counters.segments_sent);
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  rig.run_for(300ms);
  EXPECT_TRUE(status().nodes[0].stopped);
  rig.lose_to_gateway = [](const CanFrame& frame) { return (frame.id & 0x7F) == 2; };
  rig.run_for(3s);
  EXPECT_FALSE(status().nodes[1].present);
  EXPECT_TRUE(status().nodes[0].present);
}

TEST_F(States, NodesThatDoNotTellWhereTheyStandAreAnAlarm) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  rig.lose_to_gateway = [](const CanFrame& frame) { return frame.id == 0x582; };
  told();
  ASSERT_TRUE(asks(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 20s));
  EXPECT_EQ(told().find("= cancelling\n! node 2"), 0U);
  rig.lose_to_gateway = {};
  ASSERT_TRUE(asks(command::Clear{}));
  EXPECT_EQ(state(), MachineState::kOff);
}

}  // namespace
}  // namespace kinebus
