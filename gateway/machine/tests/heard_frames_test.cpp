// Frames that the gateway alone hears: what it does about them by itself, though no node complains.

#include <gtest/gtest.h>

#include <cmath>

#include "gateway/machine/tests/stranger_rig.hpp"
#include "protocol/canopen/emcy.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class HeardFrames : public ::testing::Test {
 protected:
  void hears(const char* text) { rig.gateway->on_frame(rig.now, text_frame(text)); }
  /// A node asks all to stop.
  void hears_stop(StopReason reason, std::uint8_t node = 1) {
    CanFrame emergency = encode(Emergency{.node = node, .code = 0x1000, .error_register = 1});
    const auto stop = encode(StopRequest{reason, 0, rig.now});
    std::copy(stop.begin(), stop.end(), emergency.data.begin() + 3);
    rig.gateway->on_frame(rig.now, emergency);
  }
  MachineState state() const { return rig.gateway->state(); }
  int alarms() {
    while (auto event = rig.gateway->next_event()) rig.events.push_back(std::move(*event));
    return static_cast<int>(std::count_if(rig.events.begin(), rig.events.end(), [](const MachineEvent& e) {
      return e.kind == MachineEvent::Kind::kAlarm;
    }));
  }
  bool says(const char* part) {
    alarms();
    return rig.says(part);
  }
  double bed() const { return rig.gateway->status().heater(kFirstBed).target_celsius; }
  bool heats() { return static_cast<bool>(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 60})); }

  StrangerOf<VirtualMachine> rig;
};

TEST_F(HeardFrames, ARecordOfAnotherStopsAllAtOnceAndIsToldOnce) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.begin());
  hears("402#4001000000000000");
  EXPECT_EQ(state(), MachineState::kStopping);
  EXPECT_EQ(alarms(), 1);
  hears("402#4001000000000000");
  hears("502#0000000000000000");
  EXPECT_EQ(alarms(), 1);
  EXPECT_EQ(rig.gateway->status().counters.foreign_frames, 3U);
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << "no fault of the machine's own";
}

TEST_F(HeardFrames, WhatFreesMotorsStopsAMachineAtRestAndItsPositionsAreNobodysToKnow) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  hears("302#0000000000000000");
  EXPECT_EQ(state(), MachineState::kReady) << "a set point frees none, and is not told at rest";
  EXPECT_EQ(alarms(), 0);
  EXPECT_FALSE(says("controlword or set point"));
  hears("202#00000F000000");
  EXPECT_EQ(state(), MachineState::kStopping);
  EXPECT_FALSE(rig.gateway->status().positions_known);
  EXPECT_EQ(alarms(), 1);
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s));
}

TEST_F(HeardFrames, AnOrderInMotionIsToldAndNodesRefuseIt) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.begin());
  hears("202#00000F000000");
  EXPECT_EQ(state(), MachineState::kRunning);
  EXPECT_TRUE(says("another device has sent node 2 a controlword")) << rig.story();
  EXPECT_EQ(alarms(), 0);
}

TEST_F(HeardFrames, ASecondGatewayStopsAMachineThatIsUpAndNoOther) {
  hears("080#01");
  hears("402#4001000000000000");
  hears("602#2B13210002000000");
  EXPECT_EQ(state(), MachineState::kOff);
  EXPECT_EQ(alarms(), 0);
  EXPECT_EQ(rig.gateway->status().counters.foreign_frames, 3U);
  EXPECT_FALSE(says("another device")) << "the gateway does not speak yet";
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  hears("77F#05");
  EXPECT_EQ(state(), MachineState::kStopping);
  EXPECT_TRUE(rig.told(AlarmCode::kSecondGateway) || says("another gateway has begun to speak"))
      << rig.story();
  hears("080#01");
  EXPECT_EQ(alarms(), 1) << "once";
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
}

TEST_F(HeardFrames, ANodesEmergencyStopInputCutsHeatAndItsOtherStopsDoNot) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(heats());
  hears_stop(StopReason::kCommand);
  EXPECT_EQ(state(), MachineState::kStopping);
  EXPECT_EQ(bed(), 60);
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << rig.story();
  hears_stop(StopReason::kEmergencyStopInput);
  EXPECT_EQ(bed(), 0);
  EXPECT_TRUE(says("the heaters are off: the emergency stop input")) << rig.story();
}

TEST_F(HeardFrames, AStopOfADeviceThatNobodyKnowsIsToldWhereItIsTheCause) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  hears_stop(StopReason::kCommand, 44);
  EXPECT_EQ(alarms(), 1);
  hears_stop(StopReason::kCommand, 45);
  EXPECT_EQ(alarms(), 1) << "all stop already";
}

TEST_F(HeardFrames, ABusThatFailsStopsAMachineThatIsUpOnceAndItIsBroughtUpAgain) {
  rig.gateway->on_bus_failure(rig.now, "bus-off");
  EXPECT_EQ(state(), MachineState::kOff);
  EXPECT_EQ(alarms(), 0);
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  rig.gateway->on_bus_failure(rig.now, "bus-off");
  EXPECT_EQ(state(), MachineState::kStopping);
  EXPECT_TRUE(says("the bus failed: bus-off"));
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  const int before = alarms();
  rig.gateway->on_bus_failure(rig.now, "bus-off");
  EXPECT_EQ(alarms(), before) << "told already";
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  EXPECT_EQ(state(), MachineState::kOff);
}

TEST_F(HeardFrames, WhatNobodyHereUsesIsCountedByWhatItIs) {
  const auto counters = [&] { return rig.gateway->status().counters; };
  hears("72C#05");  // a node that the machine file does not name
  EXPECT_EQ(counters().foreign_frames, 1U);
  EXPECT_EQ(counters().malformed_frames, 0U);
  hears("1AC#0102");
  EXPECT_EQ(counters().malformed_frames, 1U);
  EXPECT_EQ(counters().frames_received, 2U);
}

// What a command asks for that no machine can do, or this one not now.

TEST_F(HeardFrames, JogsWithoutNumbersAndFartherThanAMotorMayGoAloneAreRefused) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  const double nan = std::nan(""), inf = HUGE_VAL;
  const auto refused = [&](Command command) {
    const bool no = !rig.gateway->carry_out(std::move(command));
    EXPECT_EQ(state(), MachineState::kReady);
    return no;
  };
  for (const double bad : {nan, inf, -inf}) {
    EXPECT_TRUE(refused(command::Jog{.delta = {bad, 0, 0, 0, 0, 0}}));
    EXPECT_TRUE(refused(command::Jog{.delta = {0, 0, 0, 0, 0, bad}}));
    EXPECT_TRUE(refused(command::Jog{.delta = {1, 0, 0, 0, 0, 0}, .speed_per_s = bad}));
    EXPECT_TRUE(refused(command::JogMotor{.joint = 0, .distance = bad}));
    EXPECT_TRUE(refused(command::JogMotor{.joint = 0, .distance = 1, .speed_per_s = bad}));
    EXPECT_TRUE(refused(command::SetFeedOverride{bad}));
  }
  EXPECT_TRUE(refused(command::Jog{}));
  EXPECT_TRUE(refused(command::Jog{.delta = {1, 0, 0, 0, 0, 0}, .speed_per_s = -1}));
  EXPECT_TRUE(refused(command::Jog{.delta = {0, 0, 0, 0, 0, 1}})) << "cold";
  EXPECT_TRUE(refused(command::JogMotor{.joint = 6, .distance = 1})) << "there are six";
  EXPECT_TRUE(refused(command::JogMotor{.joint = 0, .distance = 0}));
  EXPECT_TRUE(refused(command::JogMotor{.joint = 0, .distance = 1, .speed_per_s = -1}));
  for (const double sense : {1., -1.}) {
    EXPECT_TRUE(refused(command::JogMotor{.joint = 0, .distance = sense * 20.1})) << "mm";
    EXPECT_TRUE(refused(command::JogMotor{.joint = 4, .distance = sense * 0.53})) << "30 degrees";
  }
  EXPECT_TRUE(refused(command::SetFeedOverride{0.0099}));
  EXPECT_TRUE(refused(command::SetFeedOverride{5.01}));
  EXPECT_TRUE(refused(command::Run{}));
  EXPECT_FALSE(refused(command::SetFeedOverride{0.01}));
  EXPECT_FALSE(refused(command::SetFeedOverride{5}));
}

}  // namespace
}  // namespace kinebus
