// What nodes say, and do not say, in each state of the machine.

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

#include "gateway/machine/tests/hand_rig.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/motion/broadcast.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class SaidInStates : public HandRig {
 protected:
  void hears(const char* text) { rig.gateway->on_frame(rig.now, *parse_frame(text)); }
  /// Node 2 tells of its stream.
  void hears_status(std::uint8_t flags, std::uint8_t next = 100) {
    CanFrame frame{.id = cob_id::tpdo(2, 2), .length = 8};
    put_u64_le(frame.data, encode(StreamStatus{.next_sequence = next, .flags = flags}));
    rig.gateway->on_frame(rig.now, frame);
  }
  bool ready_again() {
    if (state() == MachineState::kStopping) rig.run_for(1s);
    if (state() == MachineState::kAlarm || state() == MachineState::kStopped) {
      if (!asks(command::Clear{})) return false;
      rig.run_for(2s);
    }
    if (state() == MachineState::kHeld && !asks(command::Cancel{})) return false;
    rig.run_for(1s);
    if (state() == MachineState::kOff) {
      if (!asks(command::BringUp{})) return false;
      rig.run_until([&] { return state() != MachineState::kBringUp; }, 30s);
    }
    if (status().interrupted && !asks(command::Cancel{})) return false;
    if (state() == MachineState::kUnhomed && !asks(command::Home{})) return false;
    return rig.reach(MachineState::kReady, 120s) && asks(command::GoToReference{}) &&
           rig.reach(MachineState::kReady, 20s);
  }
  /// From ready to this state.
  bool comes_to(MachineState wanted) {
    const command::Jog jog{.delta = {30, 0, 0, 0, 0, 0}, .speed_per_s = 20};
    std::string lines;
    for (int i = 0; i < 3000; ++i) lines += i % 2 == 0 ? "G1 X0.1 F600\n" : "G1 X0\n";
    switch (wanted) {
      case MachineState::kReady:
        return true;
      case MachineState::kMoving:
        if (!asks(jog)) return false;
        rig.run_for(300ms);
        break;
      case MachineState::kChecking:
        if (!runs(lines)) return false;
        break;
      case MachineState::kHoming:
        if (!asks(command::Home{})) return false;
        rig.run_for(300ms);
        break;
      case MachineState::kCancelling:
        if (!runs_to(kLine, 20) || !asks(command::Cancel{})) return false;
        break;
      default:
        if (!runs_to(kLine, 20)) return false;
        if (wanted != MachineState::kRunning && !asks(command::Hold{})) return false;
        if (wanted == MachineState::kHeld) rig.reach(MachineState::kHeld, 2s);
        break;
    }
    told();
    return state() == wanted;
  }
};

TEST_F(SaidInStates, ADriveThatIsSwitchedOffIsAFaultWhereverItWasEnabled) {
  for (const MachineState wanted :
       {MachineState::kChecking, MachineState::kMoving, MachineState::kRunning, MachineState::kHolding,
        MachineState::kHeld, MachineState::kCancelling, MachineState::kHoming}) {
    SCOPED_TRACE(to_string(wanted));
    ASSERT_TRUE(state() == MachineState::kOff ? static_cast<bool>(ready()) : ready_again()) << rig.story();
    ASSERT_TRUE(comes_to(wanted)) << rig.story();
    hears("182#50023716070700");
    rig.gateway->on_time(rig.now);
    EXPECT_EQ(state(), MachineState::kStopping);
    EXPECT_EQ(told().find("! node 2: the drive of axis 1 was switched off"), 0U);
    EXPECT_FALSE(status().positions_known);
  }
}

TEST_F(SaidInStates, AnotherModeIsAFaultWhereverItFollows) {
  for (const MachineState wanted :
       {MachineState::kChecking, MachineState::kMoving, MachineState::kHeld, MachineState::kCancelling}) {
    SCOPED_TRACE(to_string(wanted));
    ASSERT_TRUE(state() == MachineState::kOff ? static_cast<bool>(ready()) : ready_again()) << rig.story();
    ASSERT_TRUE(comes_to(wanted)) << rig.story();
    hears("182#37163716010700");
    rig.gateway->on_time(rig.now);
    EXPECT_EQ(state(), MachineState::kStopping);
    EXPECT_EQ(told().find("! node 2: axis 1 was set to the mode of operation 1 by another device"), 0U);
  }
}

TEST_F(SaidInStates, InAStopThatEndsNoRunAndBehindOneADriveMayBeOff) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Stop{}));
  told();
  hears("182#50023716070700");
  rig.gateway->on_time(rig.now);
  EXPECT_EQ(told(), "");
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  hears("182#50023716070700");
  rig.run_for(100ms);
  EXPECT_EQ(told(), "= stopped\n");
}

TEST_F(SaidInStates, WhatANodeTellsOfItsStreamCountsWhileARunIsUnderWay) {
  constexpr std::uint8_t kGood = StreamStatus::kSynchronised;
  ASSERT_TRUE(ready());
  told();
  hears_status(kGood | StreamStatus::kSequenceError);
  EXPECT_EQ(told(), "") << "nothing runs";
  EXPECT_TRUE(status().positions_known);
  ASSERT_TRUE(comes_to(MachineState::kHeld));
  hears_status(kGood);
  EXPECT_EQ(told(), "! the node expects a record that was never sent (record): 100, node 2\n= stopping\n");
  EXPECT_FALSE(status().positions_known);
  hears_status(kGood);
  EXPECT_EQ(told(), "") << "its stream is lost already";
  ASSERT_TRUE(ready_again());
  ASSERT_TRUE(runs_to(kLine, 20));
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  told();
  EXPECT_TRUE(status().positions_known);
  hears_status(kGood);
  EXPECT_EQ(told(), "");
  EXPECT_FALSE(status().positions_known) << "the run cannot go on";
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  EXPECT_TRUE(status().interrupted);
  EXPECT_TRUE(status().positions_known) << "they are read";
  hears_status(kGood);
  EXPECT_EQ(told(), "= held\n") << "an interrupted job has none";
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_NEAR(x(), 0, 2e-3);
}

TEST_F(SaidInStates, NodesThatTellNothingOfTheirStreamAreMissedWhileItFlowsAlone) {
  ASSERT_TRUE(ready());
  const auto is_missed = [&](BusTime within) {
    rig.lose_to_gateway = [](const CanFrame& frame) {
      return frame.id == cob_id::tpdo(1, 2) || frame.id == cob_id::tpdo(2, 2) ||
             frame.id == cob_id::tpdo(3, 2) || frame.id == cob_id::tpdo(4, 2);
    };
    const bool missed = rig.run_until([&] { return state() == MachineState::kStopping; }, within);
    rig.lose_to_gateway = {};
    return missed;
  };
  EXPECT_FALSE(is_missed(2s)) << "at rest its heartbeat is enough";
  ASSERT_TRUE(runs("G4 P4\nG1 X10 F1200\n"));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 5s));
  rig.run_for(500ms);
  EXPECT_FALSE(is_missed(1500ms)) << "it waits between runs";
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s)) << rig.story();
  ASSERT_TRUE(comes_to(MachineState::kHeld));
  EXPECT_FALSE(is_missed(1500ms)) << "path time stands";
  ASSERT_TRUE(asks(command::Resume{}));
  rig.run_for(500ms);
  EXPECT_TRUE(is_missed(600ms));
  EXPECT_EQ(told().find("= running\n! node 2 is silent\n"), 0U);
}

TEST_F(SaidInStates, AMachineThatStopsIsToldToStopOnce) {
  std::set<std::string> stops;
  rig.on_frame = [&](BusTime when, const CanFrame& frame) {
    if (const auto command = decode_rate_command(frame, when);
        command && command->kind == RateCommand::Kind::kStop)
      stops.insert(std::to_string(command->start.count()));
  };
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  ASSERT_TRUE(asks(command::Stop{}));
  rig.run_for(20ms);
  hears("703#00");
  rig.run_for(200ms);
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  EXPECT_EQ(stops.size(), 1U) << "what comes to it in the stop is no other stop";
}

TEST_F(SaidInStates, AStopOfTheMachinesOwnNodeIsNotTakenForAStrangers) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  told();
  for (const std::uint8_t node : {std::uint8_t{2}, std::uint8_t{44}}) {
    CanFrame emergency = encode(Emergency{.node = node, .code = 0x1000, .error_register = 1});
    const auto stop = encode(StopRequest{StopReason::kCommand, 0, rig.now});
    std::copy(stop.begin(), stop.end(), emergency.data.begin() + 3);
    rig.gateway->on_frame(rig.now, emergency);
    const std::string text = told();
    EXPECT_EQ(text.find("which the machine file does not name"), std::string::npos) << text;
  }
  EXPECT_EQ(state(), MachineState::kStopping);
}

TEST_F(SaidInStates, AStopBeforeTheGatewaySpeaksIsNobodysAndInABringUpItIsNoStateOfItsOwn) {
  CanFrame emergency = encode(Emergency{.node = 44, .code = 0x1000, .error_register = 1});
  const auto stop = encode(StopRequest{StopReason::kEmergencyStopInput, 0, rig.now});
  std::copy(stop.begin(), stop.end(), emergency.data.begin() + 3);
  hand.bed.target = 60;
  rig.gateway->on_frame(rig.now, emergency);
  EXPECT_EQ(state(), MachineState::kOff);
  EXPECT_EQ(hand.bed.target, 60);
  EXPECT_EQ(told(), "");
  ASSERT_TRUE(asks(command::BringUp{}));
  rig.run_for(1200ms);
  ASSERT_EQ(state(), MachineState::kBringUp);
  told();
  rig.gateway->on_frame(rig.now, emergency);
  EXPECT_EQ(state(), MachineState::kBringUp);
  EXPECT_EQ(hand.bed.target, 0);
}

}  // namespace
}  // namespace kinebus
