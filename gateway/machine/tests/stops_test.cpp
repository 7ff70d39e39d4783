// What stops the machine in each state, what it leaves, and how the machine comes back: word for word.

#include <gtest/gtest.h>

#include <string>

#include "gateway/machine/tests/hand_rig.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/emcy.hpp"
#include "protocol/canopen/nmt.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class Stops : public HandRig {
 protected:
  /// Node 2 asks all to stop, and all hear it.
  void node_stops(StopReason reason) {
    CanFrame emergency = encode(Emergency{.node = 2, .code = 0x1000, .error_register = 1});
    const auto stop = encode(StopRequest{reason, 0, rig.now});
    std::copy(stop.begin(), stop.end(), emergency.data.begin() + 3);
    rig.stranger_sends(emergency);
  }
  ::testing::AssertionResult cleared_to(MachineState wanted) {
    if (!asks(command::Clear{})) return ::testing::AssertionFailure() << "clear is refused";
    if (!rig.reach(wanted, 5s)) return ::testing::AssertionFailure() << rig.story();
    return ::testing::AssertionSuccess();
  }
};

TEST_F(Stops, AJobRestsOnItsPathAndGoesOnFromThere) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to("M104 S200\nM140 S60\nM3 S5000\n" + kLine, 20));
  told();
  ASSERT_TRUE(asks(command::Stop{.why = say("the red button")}));
  EXPECT_EQ(hand.hotend.target, 0) << "the file's on_stop";
  EXPECT_EQ(hand.bed.target, 0);
  EXPECT_EQ(hand.spindle_rpm, 0);
  ASSERT_TRUE(asks(command::Stop{})) << "again";
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
  EXPECT_EQ(told(), "- the heaters are off: the red button\n- the red button\n= stopping\n= stopped\n");
  EXPECT_TRUE(rests());
  EXPECT_LT(x(), 25);
  EXPECT_TRUE(status().positions_known);
  ASSERT_TRUE(cleared_to(MachineState::kHeld));
  EXPECT_TRUE(status().interrupted) << "it heats first";
  told();
  ASSERT_TRUE(asks(command::Resume{}));
  rig.run_for(100ms);
  EXPECT_EQ(hand.bed.target, 60) << "beds first";
  EXPECT_EQ(hand.hotend.target, 0);
  ASSERT_TRUE(rig.run_until([&] { return !status().interrupted; }, 30s));
  ASSERT_TRUE(rig.run_until([&] { return x() > 30; }, 30s));
  EXPECT_EQ(hand.spindle_rpm, 5000);
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_EQ(hand.spindle_rpm, 0);
  EXPECT_EQ(told(), "= running\n- the job part goes on\n. job done: part\n= ready\n");
  EXPECT_NEAR(x(), 0, 2e-3);
  EXPECT_EQ(hand.hotend.target, 200);
}

TEST_F(Stops, WithoutHeatTheRunItselfGoesOn) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
  ASSERT_TRUE(cleared_to(MachineState::kHeld));
  EXPECT_FALSE(status().interrupted);
  ASSERT_TRUE(asks(command::Resume{}));
  EXPECT_EQ(state(), MachineState::kRunning) << "at once";
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_NEAR(x(), 0, 2e-3);
}

TEST_F(Stops, HeatStaysWhereTheFileSaysSoAndNotWithM112) {
  MachineDescription machine = with_devices(default_m1());
  machine.thermal.on_stop = ThermalDescription::After::kKeep;
  use(machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
  ASSERT_TRUE(asks(command::Stop{}));
  EXPECT_EQ(hand.bed.target, 60);
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
  ASSERT_TRUE(asks(command::Stop{.why = say("M112"), .heaters_off = true}));
  EXPECT_EQ(hand.bed.target, 0);
  EXPECT_EQ(told(), "- stop by command\n= stopping\n= stopped\n- the heaters are off: M112\n");
}

TEST_F(Stops, AMoveByHandGoesOnAfterOneOrNot) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Jog{.delta = {30, 0, 0, 0, 0, 0}, .speed_per_s = 20}));
  ASSERT_TRUE(asks(command::Jog{.delta = {0, 10, 0, 0, 0, 0}, .speed_per_s = 20}));
  rig.run_for(500ms);
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
  ASSERT_TRUE(cleared_to(MachineState::kHeld));
  ASSERT_TRUE(asks(command::Resume{}));
  EXPECT_EQ(state(), MachineState::kMoving);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  EXPECT_NEAR(x(), 30, 2e-3);
  EXPECT_NEAR(status().machine_pose[kY], 0, 2e-3) << "those that waited are forgotten";
}

TEST_F(Stops, AReadyMachineIsReadyAgainAfterClear) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
  ASSERT_TRUE(cleared_to(MachineState::kReady));
  EXPECT_EQ(told(), "- stop by command\n= stopping\n= stopped\n= ready\n");
  ASSERT_TRUE(runs(kLine));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 2s));
  ASSERT_TRUE(rig.reach(MachineState::kReady));
}

TEST_F(Stops, TheWayToAJobsBeginningStillLeadsToIt) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Jog{.delta = {50, 0, 0, 0, 0, 0}, .speed_per_s = 100}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  ASSERT_TRUE(runs("G1 X-20 F1200\n"));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 2s));
  EXPECT_EQ(status().progress, 0);
  rig.run_for(100ms);
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
  ASSERT_TRUE(cleared_to(MachineState::kHeld));
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_NEAR(x(), -20, 2e-3) << rig.story();
}

TEST_F(Stops, WhileItIsBroughtUpAndWhileItHomes) {
  ASSERT_TRUE(asks(command::Stop{}));
  EXPECT_EQ(state(), MachineState::kOff);
  EXPECT_EQ(told(), "- stop by command\n");
  for (const BusTime after : {200ms, 600ms, 1000ms}) {
    SCOPED_TRACE(to_seconds(after));
    ASSERT_TRUE(asks(command::BringUp{}));
    rig.run_for(after);
    ASSERT_EQ(state(), MachineState::kBringUp);
    ASSERT_TRUE(asks(command::Stop{}));
    rig.run_for(20s);
    EXPECT_EQ(told(), "= bring-up\n- stop by command\n= stopping\n= stopped\n") << "the bring-up is over";
    ASSERT_TRUE(asks(command::Clear{}));
    EXPECT_EQ(state(), MachineState::kOff) << "nodes that are half configured are brought up anew";
    rig.run_for(5s);
    told();
    if (state() != MachineState::kOff) {
      ASSERT_TRUE(asks(command::MotorsOff{}));
    }
  }
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
  ASSERT_TRUE(asks(command::Home{}));
  rig.run_for(1s);
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s)) << rig.story();
  EXPECT_TRUE(rests());
  EXPECT_FALSE(status().positions_known);
  rig.run_for(20s);
  EXPECT_TRUE(rests()) << "nothing homes on";
  ASSERT_TRUE(cleared_to(MachineState::kUnhomed));
  ASSERT_TRUE(asks(command::Home{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 120s));
}

TEST_F(Stops, InTheCheckOfAJobItIsGivenUp) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs(kLine));
  ASSERT_EQ(state(), MachineState::kChecking);
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
  ASSERT_TRUE(cleared_to(MachineState::kReady));
  rig.run_for(1s);
  EXPECT_EQ(state(), MachineState::kReady);
  EXPECT_NEAR(x(), 0, 2e-3);
  ASSERT_TRUE(runs_to(kLine, 5));
}

TEST_F(Stops, AHeldJobIsStoppedWhereItIs) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  ASSERT_TRUE(asks(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 1s));
  const double held_x = x();
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 1s));
  EXPECT_NEAR(x(), held_x, 1e-3);
  ASSERT_TRUE(cleared_to(MachineState::kHeld));
  ASSERT_TRUE(asks(command::Resume{}));
  EXPECT_EQ(state(), MachineState::kRunning);
  ASSERT_TRUE(rig.reach(MachineState::kReady));
}

TEST_F(Stops, M112InAJobSwitchesHeatOffAndIsAnAlarmThatAsksForNoFault) {
  MachineDescription machine = with_devices(default_m1());
  machine.thermal.on_stop = ThermalDescription::After::kKeep;
  use(machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs("M140 S60\nG1 X20 F6000\nM112\nG1 X0\n"));
  ASSERT_TRUE(rig.reach(MachineState::kStopped));
  EXPECT_EQ(told(),
            "= checking the job\n? warning: M112 stops the machine here\n= running\n! M112 in the job\n"
            "- the heaters are off: M112 in the job\n= stopping\n= stopped\n");
  EXPECT_EQ(hand.bed.target, 0);
}

TEST_F(Stops, ANodesOwnRequestStopsAllAndSaysWhatIsLeft) {
  struct Case {
    StopReason reason;
    MachineState ends;
    bool stream_lost;
  };
  for (const Case& c : {Case{StopReason::kCommand, MachineState::kStopped, false},
                        Case{StopReason::kEmergencyStopInput, MachineState::kStopped, false},
                        Case{StopReason::kPeer, MachineState::kStopped, false},
                        Case{StopReason::kStarved, MachineState::kStopped, true},
                        Case{StopReason::kSequenceError, MachineState::kStopped, true},
                        Case{StopReason::kCheckpointError, MachineState::kStopped, true},
                        Case{StopReason::kStreamError, MachineState::kStopped, true},
                        Case{StopReason::kAxisFault, MachineState::kAlarm, false}}) {
    SCOPED_TRACE(static_cast<int>(c.reason));
    rig.events.clear();
    if (state() != MachineState::kReady) {
      ASSERT_TRUE(ready());
    }
    ASSERT_TRUE(runs_to(kLine, 20));
    ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
    told();
    node_stops(c.reason);
    ASSERT_TRUE(rig.reach(c.ends, 2s)) << rig.story();
    EXPECT_TRUE(rests());
    EXPECT_LT(x(), 26);
    const bool cut = c.reason == StopReason::kEmergencyStopInput || c.ends == MachineState::kAlarm;
    EXPECT_EQ(hand.bed.target, cut ? 0 : 60);
    EXPECT_EQ(status().positions_known, !c.stream_lost);
    const std::string text = told();
    EXPECT_NE(text.find("! node 2: "), std::string::npos) << text;
    ASSERT_TRUE(asks(command::Clear{}));
    ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
    EXPECT_EQ(status().interrupted, c.stream_lost || cut) << "else the run itself goes on";
    ASSERT_TRUE(asks(command::Cancel{}));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 5s)) << rig.story();
    ASSERT_TRUE(asks(command::GoToReference{}));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 10s)) << rig.story();
  }
}

TEST_F(Stops, ANodeThatIsLostNeedsABringUpAndTheJobGoesOnAfterIt) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  told();
  rig.lose_to_gateway = [](const CanFrame& frame) { return (frame.id & 0x7F) == 2; };
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  EXPECT_EQ(told(), "! node 2 is silent\n= stopping\n= alarm\n");
  rig.lose_to_gateway = {};
  ASSERT_TRUE(asks(command::Clear{}));
  EXPECT_EQ(state(), MachineState::kOff) << "at once";
  EXPECT_EQ(told(), "- cleared: resume brings the machine up again and goes on with the job\n= off\n");
  EXPECT_FALSE(status().positions_known);
  EXPECT_EQ(status().job, "part");
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_EQ(told(), "= bring-up\n= ready\n- the job part goes on\n= running\n. job done: part\n= ready\n");
  EXPECT_NEAR(x(), 0, 2e-3);
}

TEST_F(Stops, AMoveByHandIsForgottenWithTheNodesThatAreLost) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Jog{.delta = {30, 0, 0, 0, 0, 0}, .speed_per_s = 20}));
  rig.run_for(500ms);
  told();
  rig.gateway->on_bus_failure(rig.now, "bus-off");
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  EXPECT_EQ(told(), "! the bus failed: bus-off\n= stopping\n= alarm\n");
  ASSERT_TRUE(asks(command::Clear{}));
  EXPECT_EQ(told(), "- cleared: bring the machine up again\n= off\n");
  EXPECT_EQ(status().job, "");
  EXPECT_EQ(why_not(command::Resume{}), "there is no interrupted job to resume");
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  EXPECT_TRUE(rests());
}

TEST_F(Stops, ANodeThatRestartsHasLostItsPositions) {
  ASSERT_TRUE(ready());
  rig.gateway->on_frame(rig.now, heartbeat_frame(NmtState::kInitialising, 3));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  EXPECT_EQ(told(), "! node 3 has restarted\n= stopping\n= alarm\n");
  EXPECT_FALSE(status().positions_known);
  ASSERT_TRUE(asks(command::Clear{}));
  EXPECT_EQ(state(), MachineState::kOff);
}

TEST_F(Stops, ANodeThatIsTakenOutOfOperationIsNamed) {
  for (const NmtState nmt : {NmtState::kStopped, NmtState::kPreOperational}) {
    ASSERT_TRUE(state() == MachineState::kReady || ready());
    told();
    rig.gateway->on_frame(rig.now, heartbeat_frame(nmt, 1));
    ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
    EXPECT_EQ(
        told(),
        "! node 1 was taken out of operation by an NMT command of another device\n= stopping\n= alarm\n");
    ASSERT_TRUE(asks(command::Clear{}));
    ASSERT_TRUE(asks(command::BringUp{}));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 30s));
  }
}

TEST_F(Stops, WhatTheGatewaysOwnAbsenceHasStoppedGoesOnByItselfWhereTheFileSaysSo) {
  MachineDescription machine = with_devices(default_m1());
  machine.stop.after_stall = StopDescription::AfterStall::kGoOn;
  use(machine);
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  told();
  rig.stall(900ms);
  ASSERT_TRUE(rig.run_until([&] { return state() == MachineState::kStopped; }, 3s));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 10s)) << rig.story();
  EXPECT_NE(told().find("- the gateway is back: the job goes on by itself\n"), std::string::npos);
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_NEAR(x(), 0, 2e-3);
  ASSERT_TRUE(asks(command::Jog{.delta = {30, 0, 0, 0, 0, 0}, .speed_per_s = 20}));
  rig.run_for(500ms);
  rig.stall(900ms);
  rig.run_for(10s);
  EXPECT_EQ(state(), MachineState::kStopped) << "a move by hand waits for the hand";
  ASSERT_TRUE(cleared_to(MachineState::kHeld));
}

TEST_F(Stops, HeatIsOffWithAFaultAndStaysWithAStopWithoutOne) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::SetTemperature{kFirstBed, 60}));
  rig.gateway->on_frame(rig.now, heartbeat_frame(NmtState::kInitialising, 3));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  EXPECT_EQ(hand.bed.target, 0);
}

}  // namespace
}  // namespace kinebus
