// Commands at moments at which something else is under way: what they refuse, what they end, what they leave.

#include <gtest/gtest.h>

#include <string>

#include "gateway/machine/tests/hand_rig.hpp"
#include "protocol/can/candump.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class Commanded : public HandRig {
 protected:
  /// Up to the moment at which a node is asked for something.
  bool asks_nodes(BusTime limit) {
    bool asked = false;
    rig.on_frame = [&](BusTime, const CanFrame& frame) {
      asked = asked || (frame.id > 0x600 && frame.id <= 0x603);
    };
    const bool came = rig.run_until([&] { return asked; }, limit);
    rig.on_frame = {};
    return came;
  }
  bool shows_currents() {
    int asked = 0;
    rig.on_frame = [&](BusTime, const CanFrame& frame) {
      asked += frame.id > 0x600 && frame.id <= 0x603 ? 1 : 0;
    };
    for (const BusTime until = rig.now + 1s; rig.now < until; rig.run_for(100ms))
      rig.gateway->watch_currents();
    rig.on_frame = {};
    return asked > 0;
  }
};

TEST_F(Commanded, AMotorIsJoggedAloneAtItsOwnPaceByItsOwnLimit) {
  ASSERT_TRUE(ready());
  const auto takes = [&](command::JogMotor jog) {
    const BusTime from = rig.now;
    const auto done = asks(jog);
    EXPECT_TRUE(done) << done.error().words;
    EXPECT_TRUE(rig.reach(MachineState::kReady, 20s));
    return to_seconds(rig.now - from);
  };
  ASSERT_TRUE(rig.machine.joints[4].rotary);
  EXPECT_NEAR(takes({.joint = 4, .distance = 0.3}), 3, 0.5) << "0.1 rad/s";
  EXPECT_NEAR(takes({.joint = 4, .distance = -0.3, .speed_per_s = 0.3}), 1, 0.5);
  EXPECT_EQ(why_not(command::JogMotor{.joint = 4, .distance = 0.53}),
            "one motor alone goes at most 20 mm or 30 degrees: the others hold the tool");
  const double e = status().joints[5];
  EXPECT_NEAR(takes({.joint = 5, .distance = -10}), 2, 0.4) << "filament, 5 mm/s";
  EXPECT_NEAR(status().joints[5], e - 10, 0.01);
  EXPECT_EQ(why_not(command::JogMotor{.joint = 0, .distance = 0}), "a jog needs a distance");
  EXPECT_EQ(why_not(command::JogMotor{.joint = 0, .distance = 1, .speed_per_s = -1}), "a jog needs numbers");
}

TEST_F(Commanded, ACancelWhileALiftIsPreparedEndsTheJobThere) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to("M104 S200\nG1 X60 E6 F1200\nG1 X0\n", 20));
  hand.hotend.broken = true;
  ASSERT_TRUE(rig.run_until([&] { return state() == MachineState::kHolding; }, 1s));
  rig.run_for(100ms);
  ASSERT_TRUE(asks_nodes(2s)) << "where they stand";
  const double z_mm = z();
  told();
  ASSERT_TRUE(asks(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 2s));
  EXPECT_EQ(told(), "= cancelling\n- cancelled: positions are known\n= ready\n");
  EXPECT_NEAR(z(), z_mm, 2e-3) << "nothing is lifted";
  EXPECT_FALSE(status().interrupted);
}

TEST_F(Commanded, AClearIsOneHoweverOftenItIsGiven) {
  ASSERT_TRUE(ready());
  for (const bool reads : {false, true}) {
    SCOPED_TRACE(reads);
    ASSERT_TRUE(asks(command::Stop{}));
    ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
    told();
    ASSERT_TRUE(asks(command::Clear{}));
    if (reads) {
      ASSERT_TRUE(asks_nodes(2s));
    } else {
      rig.run_for(5ms);
    }
    ASSERT_EQ(state(), MachineState::kStopped);
    ASSERT_TRUE(asks(command::Clear{}));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
    EXPECT_EQ(told(), "= ready\n");
    EXPECT_TRUE(shows_currents()) << "nothing of it is left";
    ASSERT_TRUE(runs_to(kLine, 10));
    ASSERT_TRUE(rig.reach(MachineState::kReady));
  }
}

TEST_F(Commanded, MotorsThatAreSwitchedOffInAClearLeaveNothingOfIt) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Jog{.delta = {30, 0, 0, 0, 0, 0}, .speed_per_s = 20}));
  rig.run_for(500ms);
  ASSERT_TRUE(asks(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  ASSERT_TRUE(asks(command::Clear{}));
  ASSERT_TRUE(asks(command::MotorsOff{}));
  EXPECT_EQ(state(), MachineState::kOff);
  EXPECT_EQ(status().doing.english(), "off") << "the jog is forgotten";
  EXPECT_EQ(status().elapsed_s, 0);
  EXPECT_FALSE(status().positions_known);
  rig.run_for(1s);
  for (const NodeStatus& node : status().nodes)
    EXPECT_EQ(node.statusword[0] & 0x6F, 0x21) << "ready to switch on, without current";
  EXPECT_EQ(state(), MachineState::kOff);
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s)) << rig.story();
  EXPECT_TRUE(shows_currents());
}

TEST_F(Commanded, AWayToAJobThatIsCancelledLeadsToNone) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Jog{.delta = {50, 0, 0, 0, 0, 0}, .speed_per_s = 100}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  ASSERT_TRUE(runs("G1 X-20 F1200\n"));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 2s));
  rig.run_for(50ms);
  ASSERT_TRUE(asks(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 2s));
  EXPECT_EQ(status().job, "");
  told();
  ASSERT_TRUE(asks(command::GoToReference{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  rig.run_for(100ms);
  EXPECT_EQ(told(), "= moving\n. move done\n= ready\n");
}

TEST_F(Commanded, WhatFeedsByAHostOrByHandMayBeTurnedDown) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::SetTemperature{kFirstHotend, 200}));
  ASSERT_TRUE(asks(command::OpenLines{"host"}));
  ASSERT_TRUE(rig.gateway->take_line("G1 X20 E4 F1200", 1));
  ASSERT_TRUE(rig.run_until([&] { return x() > 10; }, 10s));
  EXPECT_EQ(why_not(command::SetTemperature{kFirstHotend, 150}), "") << "the host knows what it does";
}

TEST_F(Commanded, AHostsWorkOffsetIsThatOfItsOwnPlaceAndItsModesAreForgottenWithIt) {
  EXPECT_FALSE(rig.gateway->lines_open());
  ASSERT_TRUE(ready());
  ASSERT_TRUE(rig.gateway->take_line("G91", 1));
  rig.gateway->forget_line_modes();
  ASSERT_TRUE(asks(command::OpenLines{"host"}));
  EXPECT_TRUE(rig.gateway->lines_open());
  ASSERT_TRUE(rig.gateway->take_line("G1 X10 F3000", 2));
  ASSERT_TRUE(rig.gateway->take_line("G1 X10 F3000", 3));
  ASSERT_TRUE(asks(command::SetWorkOffset{.system = 1, .here = true}));
  EXPECT_NEAR(status().work_offset[kX], 10, 2e-3) << "where its lines lead to";
  rig.run_for(3s);
  EXPECT_NEAR(x(), 10, 2e-3) << "absolute again";
  EXPECT_EQ(rig.gateway->work_offsets()[0][kX], status().work_offset[kX]);
}

TEST_F(Commanded, AnOverrideIsOfTheJobThatIsUnderWayOrNext) {
  EXPECT_EQ(why_not(command::SetFeedOverride{0.009}), "a feed override is 0.01 to 5");
  EXPECT_EQ(why_not(command::SetFeedOverride{5.01}), "a feed override is 0.01 to 5");
  EXPECT_EQ(why_not(command::SetFeedOverride{5}), "");
  EXPECT_EQ(why_not(command::SetFeedOverride{0.01}), "");
  EXPECT_EQ(why_not(command::SetFeedOverride{2}), "");
  ASSERT_TRUE(ready());
  EXPECT_EQ(status().feed_override, 2) << "of the next job";
  const BusTime from = rig.now;
  ASSERT_TRUE(asks(command::Jog{.delta = {20, 0, 0, 0, 0, 0}, .speed_per_s = 10}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  EXPECT_NEAR(to_seconds(rig.now - from), 1, 0.4) << "moves by hand take it, too";
  ASSERT_TRUE(runs("G1 X40 F1200\n"));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 2s));
  told();
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  EXPECT_EQ(told(), ". job done: part\n- the feed is as programmed again\n= ready\n");
  EXPECT_EQ(status().feed_override, 1);
}

TEST_F(Commanded, AStopWhileAFoundTextIsReadToItsPlaceLeavesTheJobToBeGoneOnWith) {
  std::string text;
  for (int i = 0; i < 8000; ++i) text += "G90\n";
  text += kLine;
  use(rig.machine, {.journal = true});
  ASSERT_TRUE(ready());
  journal::State left;
  std::uint64_t stored = 0;
  const auto store = [&] {
    for (; const auto record = rig.gateway->next_journal_record(); ++stored) left.take(*record);
    rig.gateway->on_journal_stored(stored);
    return false;
  };
  ASSERT_TRUE(runs(text));
  ASSERT_TRUE(rig.run_until([&] { return store() || (state() == MachineState::kRunning && x() > 30); }, 30s));
  rig.lose_from_gateway = rig.lose_to_gateway = [](const CanFrame&) { return true; };
  rig.run_for(1200ms);
  rig.lose_from_gateway = rig.lose_to_gateway = {};
  use(rig.machine, {.epoch = 2});
  ASSERT_TRUE(rig.gateway->recover(left, std::make_unique<StringSource>(text)));
  for (const BusTime after : {21ms, 30ms}) {
    ASSERT_TRUE(asks(command::Resume{}));
    ASSERT_TRUE(rig.reach(MachineState::kChecking, 30s)) << rig.story();
    told();
    rig.run_for(after);
    ASSERT_EQ(state(), MachineState::kChecking);
    ASSERT_TRUE(asks(command::Stop{}));
    ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
    ASSERT_TRUE(asks(command::Clear{}));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 5s)) << rig.story();
    EXPECT_TRUE(status().interrupted);
    EXPECT_EQ(status().job, "part");
  }
  told();
  ASSERT_TRUE(asks(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return told().find("the job part goes on") != std::string::npos; }, 30s));
}

TEST_F(Commanded, AJobThatIsLostInItsCheckLeavesNoName) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs(kLine));
  ASSERT_EQ(state(), MachineState::kChecking);
  rig.gateway->on_bus_failure(rig.now, "gone");
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 2s));
  told();
  ASSERT_TRUE(asks(command::Clear{}));
  EXPECT_EQ(told(), "- cleared: bring the machine up again\n= off\n");
  EXPECT_EQ(status().job, "");
  EXPECT_FALSE(status().interrupted);
}

}  // namespace
}  // namespace kinebus
