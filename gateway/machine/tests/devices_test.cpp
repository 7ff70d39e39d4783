// Devices from the gateway's side: by index, injected, and on nodes that have no axes.

#include <gtest/gtest.h>

#include "gateway/machine/tests/machine_rig.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr HeaterId kSecondHotend{HeaterKind::kHotend, 1}, kChamber{HeaterKind::kChamber, 0};

MachineDescription printer_of_two_tools() {
  MachineDescription machine = default_m1();
  machine.heaters.push_back({.name = "left", .index = 1});
  machine.heaters.push_back({.name = "oven", .kind = HeaterKind::kChamber, .max_c = 80});
  machine.fans.push_back({.name = "side", .index = 1});
  machine.outputs = {{.name = "lamp", .index = 2}};
  return machine;
}

TEST(MachineDevices, AJobHeatsAndBlowsByIndex) {
  MachineRig rig(printer_of_two_tools());
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.run_job("M141 S50\nM106 P1 S127.5\nM42 P2 S255\nM109 T1 S100\nG1 X5 F3000\n", 600s))
      << rig.story();
  const MachineStatus s = rig.gateway->status();
  EXPECT_NEAR(s.heater(kSecondHotend).actual_celsius, 100, 3);
  EXPECT_EQ(s.heater(kChamber).target_celsius, 50);
  EXPECT_EQ(s.heater(kFirstHotend).target_celsius, 0);
  EXPECT_EQ(s.fans[0].ratio, 0);
  EXPECT_EQ(s.fans[1].ratio, 0.5);
  EXPECT_EQ(s.outputs[0].ratio, 1);
  EXPECT_EQ(rig.gateway->text_line("M105")->substr(0, 2), "T:");
  EXPECT_NE(rig.gateway->text_line("M105")->find(" T1:"), std::string::npos);
  ASSERT_TRUE(rig.gateway->text_line("M104 T1 S60"));
  EXPECT_EQ(rig.gateway->status().heater(kSecondHotend).target_celsius, 60);
}

TEST(MachineDevices, WhatIsNotThereIsRefusedBeforeAnythingMoves) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  for (const char* job : {"M190 P1 S60\n", "M141 S40\n", "M42 P0 S1\n", "M104 T1 S200\n"}) {
    rig.events.clear();
    ASSERT_TRUE(rig.run_job(job)) << job;
    EXPECT_NE(rig.story().find("error: "), std::string::npos) << job << rig.story();
  }
  rig.events.clear();
  ASSERT_TRUE(rig.run_job("M106 P1 S255\nM106 P1 S200\nG1 X5 F3000\n")) << rig.story();
  const std::string story = rig.story();
  const std::size_t at = story.find("warning: this machine has no fan 1");
  EXPECT_NE(at, std::string::npos) << story;
  EXPECT_EQ(story.find("warning: this machine has no fan 1", at + 1), std::string::npos) << "told once";
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 5, 2e-3);
  EXPECT_FALSE(rig.gateway->carry_out(command::SetTemperature{kSecondHotend, 100}));
}

/// A heater whose sensor breaks when the test says so.
class FragileHeater : public Heater {
 public:
  explicit FragileHeater(const bool& broken) : broken_(broken) {}
  void set_target(double celsius) override { target_ = celsius; }
  HeaterStatus status() const override { return {.actual_celsius = target_, .target_celsius = target_}; }
  std::optional<Sentence> fault() const override {
    return broken_ ? std::optional(Sentence::verbatim("the sensor is open")) : std::nullopt;
  }

 private:
  const bool& broken_;
  double target_ = 0;
};

MachineRig& with_fragile_heater(MachineRig& rig, const bool& broken) {
  Devices devices;
  devices.add(kFirstHotend, "hotend", 0, std::make_unique<FragileHeater>(broken));
  rig.gateway = std::make_unique<Gateway>(rig.machine, Gateway::Options{}, std::move(devices));
  return rig;
}

TEST(MachineDevices, AFaultOfAnInjectedHeaterHoldsTheJobAndItGoesOnWhenThatIsMended) {
  MachineRig rig;
  bool broken = false;
  with_fragile_heater(rig, broken);
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(
      command::Run{std::make_unique<StringSource>("M104 S200\nG1 X60 F1200\nG1 X0\n"), "line"}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().machine_pose[kX] > 20; }, 30s)) << rig.story();
  const double z_mm = rig.gateway->status().machine_pose[kZ];
  broken = true;
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  EXPECT_TRUE(rig.told(AlarmCode::kThermal));
  EXPECT_EQ(rig.gateway->status().doing.english(), "heater.hotend: the sensor is open");
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 0);
  EXPECT_NEAR(rig.gateway->status().machine_pose[kZ], z_mm + rig.machine.thermal.lift_mm, 2e-3);

  rig.events.clear();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  rig.run_for(5s);
  EXPECT_TRUE(rig.told(AlarmCode::kThermal)) << rig.story();
  EXPECT_EQ(rig.gateway->state(), MachineState::kHeld);
  EXPECT_NEAR(rig.gateway->status().machine_pose[kZ], z_mm + rig.machine.thermal.lift_mm, 2e-3);

  broken = false;
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], 0, 2e-3);
  EXPECT_NEAR(rig.gateway->status().machine_pose[kZ], z_mm, 2e-3);
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 200);
}

TEST(MachineDevices, AFaultOfAnInjectedHeaterWithoutAJobIsAnAlarm) {
  MachineRig rig;
  bool broken = false;
  with_fragile_heater(rig, broken);
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 200}));
  command::Jog jog;
  jog.delta[kX] = 40;
  ASSERT_TRUE(rig.gateway->carry_out(jog));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().machine_pose[kX] > 20; }, 30s)) << rig.story();
  broken = true;
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 0);
  EXPECT_TRUE(rig.gateway->status().positions_known);
}

TEST(MachineDevices, ADeviceThatNobodyStandsBehindRefusesEveryCommand) {
  MachineDescription machine = default_m1();
  machine.heaters[0].place = {DevicePlace::Where::kNode, 3, 1};
  Gateway gateway(machine);
  const auto refused = gateway.carry_out(command::BringUp{});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().words.find("heater.bed is to live on node 3"), std::string::npos);
}

/// M1 and a node 4 without axes. The virtual one has a pair of them, which nobody may touch.
MachineDescription with_device_node() {
  MachineDescription machine = default_m1();
  machine.nodes.push_back({.id = 4,
                           .vendor = {},
                           .product = {},
                           .serial = {},
                           .functions = {.axis_pairs = 0, .inputs = 0, .heaters = 2}});
  return machine;
}

TEST(MachineDevices, ANodeWithoutAxesIsBroughtUpAndAskedForNothingThatItDoesNotHave) {
  MachineRig rig(with_device_node());
  int to_axes = 0;
  rig.on_frame = [&](BusTime, const CanFrame& frame) {
    for (int pdo = 1; pdo <= 4; ++pdo) to_axes += frame.id == cob_id::rpdo(pdo, 4) ? 1 : 0;
  };
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.run_job("G1 X20 F3000\nG1 X0\n")) << rig.story();
  const MachineStatus s = rig.gateway->status();
  ASSERT_EQ(s.nodes.size(), 4u);
  EXPECT_TRUE(s.nodes[3].present);
  EXPECT_EQ(s.nodes[3].nmt_state, 5);
  EXPECT_FALSE(s.nodes[3].has_axes);
  EXPECT_EQ(to_axes, 0);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

TEST(MachineDevices, ANodeWithoutAxesThatFallsSilentIsToldAndPositionsStayKnown) {
  MachineRig rig(with_device_node());
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  rig.lose_to_gateway = [](const CanFrame& frame) { return (frame.id & 0x7F) == 4; };
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  EXPECT_TRUE(rig.told(AlarmCode::kHeartbeatLost));
  EXPECT_NE(rig.story().find("node 4 is silent"), std::string::npos) << rig.story();
  EXPECT_TRUE(rig.gateway->status().positions_known);
}

TEST(MachineDevices, M112SwitchesHeatersOffAndAJobThatGoesOnHeatsFirst) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(
      command::Run{std::make_unique<StringSource>("M109 S60\nG1 X40 F600\nG1 X-40\n"), "part"}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] > 20; }, 200s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{.why = say("M112"), .heaters_off = true}));
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 0);
  ASSERT_TRUE(rig.reach(MachineState::kStopped)) << rig.story();
  EXPECT_NE(rig.story().find("the heaters are off: M112"), std::string::npos) << rig.story();
  rig.run_for(60s);
  ASSERT_LT(rig.gateway->status().heater(kFirstHotend).actual_celsius, 55);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld)) << rig.story();
  const double x = rig.gateway->status().pose[kX];
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] > x + 0.5; }, 200s)) << rig.story();
  EXPECT_GT(rig.gateway->status().heater(kFirstHotend).actual_celsius, 55) << "it moves when it is hot again";
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  EXPECT_NEAR(rig.gateway->status().pose[kX], -40, 2e-3);
}

TEST(MachineDevices, AStopWhileSwitchedOffIsHarmless) {
  MachineRig rig;
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  rig.run_for(5s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kOff);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
  EXPECT_TRUE(rig.make_ready()) << rig.story();
}

}  // namespace
}  // namespace kinebus
