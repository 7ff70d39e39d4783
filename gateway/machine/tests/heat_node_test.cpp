// A printer whose heat is on the bus: gateway core, axis nodes, a heat node with its plant, in virtual time.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/machine/tests/heat_printer.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class HeatOnTheBus : public HeatPrinter {
 protected:
  HeatOnTheBus() {
    rig.on_frame = [this](BusTime when, const CanFrame& frame) {
      if ((frame.id & 0x7F) != kHeatId || frame.id < 0x80) return;
      if (frame.id == cob_id::kSdoRequest + kHeatId && (frame.data[0] & 0xE0) == 0x20) ++written;
      bits += 130;
      since = std::min(since, when);
    };
  }
  /// Off the line along X on which a job moves, mm.
  double off_the_line() {
    const Pose pose = rig.gateway->status().machine_pose;
    return std::max(std::abs(pose[kY] - line[kY]), std::abs(pose[kZ] - line[kZ]));
  }

  Pose line{};
  int written = 0;
  std::int64_t bits = 0;
  BusTime since = BusTime::max();
};

const std::string kPrint = "M140 S50\nM104 S200\nM190 S50\nM109 S200\nM106 S255\nG1 X60 F600\nG1 X-60\n";

TEST_F(HeatOnTheBus, AJobHeatsWaitsAndPrintsAndTheBusHardlyNoticesIt) {
  ASSERT_TRUE(begin(kPrint)) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] > 20; }, 900s)) << rig.story();
  EXPECT_NEAR(hotend(), 200, 3);
  EXPECT_NEAR(bed(), 50, 2.5);
  EXPECT_NEAR(rig.nodes.heat_plant(kHeat).bed().block(), 50, 4);
  EXPECT_EQ(rig.nodes.heat_node(kHeat).fan_output(1), heat::kFullFan);
  EXPECT_EQ(rig.nodes.heat_node(kHeat).fan_output(0), heat::kFullFan) << "the hot end's own";
  EXPECT_NEAR(rig.gateway->status().sensors[0].celsius, 24, 1);
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
  EXPECT_LT(static_cast<double>(bits) / 1e6 / to_seconds(rig.now - since), 0.005) << "of the bus";
  // Found as it was left: no setting is written, and what is hot stays hot.
  ASSERT_TRUE(rig.gateway->carry_out(command::MotorsOff{}));
  written = 0;
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  rig.run_for(1s);
  EXPECT_NEAR(hotend(), 200, 5);
  EXPECT_LT(written, 20) << "targets and outputs, no settings";
}

class WiredOtherwise : public HeatPrinter {
 protected:
  /// A thermistor by its resistance at three temperatures; a fan that needs half of its power to
  /// turn; a lamp.
  static MachineDescription machine() {
    MachineDescription m = printer_on_the_bus();
    const auto hotend = std::find_if(m.heaters.begin(), m.heaters.end(),
                                     [](const HeaterDescription& h) { return h.id() == kFirstHotend; });
    SensorWiring& sensor = hotend->wiring.sensor;
    sensor = {
        .element = SensorElement::kPoints, .points_c = {20, 100, 200}, .points_ohm = {126e3, 5500, 500}};
    m.fans[0].kick = 0ms;
    m.fans[0].least_percent = 50;
    m.nodes[kHeat].functions.outputs = 3;
    m.outputs = {{.name = "lamp", .place = {DevicePlace::Where::kNode, kHeatId, 3}}};
    return m;
  }
  WiredOtherwise() : HeatPrinter(machine()) {}
  /// Of full power.
  double output(int channel) {
    return rig.nodes.heat_node(kHeat).fan_output(channel) / static_cast<double>(heat::kFullFan);
  }
};

TEST_F(WiredOtherwise, TheNodeMeasuresWithAThermistorOfThreePoints) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  for (const double celsius : {60.0, 200.0}) {
    ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, celsius}));
    ASSERT_TRUE(rig.run_until([&] { return hotend() > celsius - 1; }, 300s)) << rig.story();
    rig.run_for(60s);
    EXPECT_NEAR(hotend(), rig.nodes.heat_plant(kHeat).hot_end().sensor(), 0.6);
  }
}

TEST_F(WiredOtherwise, AFanHasItsLeastPowerAndALampIsDimmedAsItIsTold) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetFan{.ratio = 0.1}));
  ASSERT_TRUE(rig.gateway->carry_out(command::SetOutput{.ratio = 0.1}));
  double brightest = 0, strongest = 0;
  for (int i = 0; i < 20; ++i) {
    rig.run_for(100ms);
    strongest = std::max(strongest, output(1));
    brightest = std::max(brightest, output(2));
  }
  EXPECT_NEAR(output(1), 0.5, 0.001);
  EXPECT_NEAR(strongest, 0.5, 0.001) << "no kick was asked for";
  EXPECT_NEAR(brightest, 0.1, 0.001) << "neither a kick nor a least power";
}

TEST_F(HeatOnTheBus, BeforeBringUpAHeaterIsRefusedWithWhatToDo) {
  const auto refused = rig.gateway->carry_out(command::SetTemperature{kFirstBed, 60});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().words.english(),
            "node 20, which heats it, is not in operation: bring the machine up first");
  EXPECT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 0}));
}

TEST_F(HeatOnTheBus, ColdExtrusionIsRefusedByWhatTheNodeMeasures) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  command::Jog feed{.speed_per_s = 5};
  feed.delta[kE] = 5;
  const auto refused = rig.gateway->carry_out(feed);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().words.find("too cold"), std::string::npos) << refused.error().words;
}

TEST_F(HeatOnTheBus, ADeadHeatNodeIsNamedAndTheJobGoesOnWhenItIsBack) {
  ASSERT_TRUE(begin(kPrint)) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] > 20; }, 900s)) << rig.story();
  line = rig.gateway->status().machine_pose;
  rig.nodes.set_power(kHeat, rig.now, false);
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  EXPECT_LT(off_the_line(), 2e-3);
  EXPECT_NE(rig.story().find("node 20 is silent"), std::string::npos) << rig.story();
  EXPECT_TRUE(rig.gateway->status().positions_known);
  rig.run_for(10s);
  rig.nodes.set_power(kHeat, rig.now, true);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] < -20; }, 600s)) << rig.story();
  EXPECT_GT(hotend(), 190);
  EXPECT_GT(bed(), 47);
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
}

TEST_F(HeatOnTheBus, WithoutTheGatewayTheNodeFallsToWhatIsSafe) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 200}));
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 60}));
  ASSERT_TRUE(rig.run_until([&] { return bed() > 45 && hotend() > 100; }, 300s)) << rig.story();
  // As a gateway that is dead: none of its frames comes out.
  rig.lose_from_gateway = [](const CanFrame&) { return true; };
  rig.run_for(3500ms);  // of 5 s, and its last heartbeat was up to 0.5 s ago
  EXPECT_TRUE(rig.run_until([&] { return power(0) > 0; }, 1s));
  rig.run_for(1600ms);
  EXPECT_FALSE(rig.run_until([&] { return power(0) > 0; }, 10s));
  EXPECT_GT(rig.nodes.heat_plant(kHeat).bed().block(), 38);
  rig.run_for(10s);
  EXPECT_EQ(power(1), 0) << "the bed, too, after its time";
}

TEST_F(HeatOnTheBus, TheEmergencyStopInputTakesTheHeatWithoutTheGateway) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  for (const HeaterId heater : {kFirstHotend, kFirstBed})
    ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{heater, 60}));
  rig.run_for(5s);
  ASSERT_GT(power(0) + power(1), 0);
  // The gateway is deaf and dumb; a node with axes tells of its button.
  rig.lose_to_gateway = rig.lose_from_gateway = [](const CanFrame&) { return true; };
  rig.run_for(100ms);
  ASSERT_GT(power(0) + power(1), 0);
  rig.nodes.set_input(2, rig.now, 7, true);
  rig.run_for(200ms);
  EXPECT_EQ(power(0) + power(1), 0);
}

TEST_F(HeatOnTheBus, AfterTheEmergencyStopTheJobHeatsBeforeItGoesOn) {
  ASSERT_TRUE(begin("M109 S60\nG1 X40 F600\nG1 X-40\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] > 20; }, 200s)) << rig.story();
  rig.nodes.set_input(2, rig.now, 7, true);
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << rig.story();
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 0);
  EXPECT_NE(rig.story().find("the heaters are off: the emergency stop input"), std::string::npos)
      << rig.story();
  rig.run_for(30s);
  rig.nodes.set_input(2, rig.now, 7, false);
  rig.run_for(1s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] < 0; }, 200s)) << rig.story();
  EXPECT_GT(hotend(), 55);
}

TEST_F(HeatOnTheBus, WhatIsHotIsNotLeftAloneForLong) {
  ASSERT_TRUE(begin("M109 S60\nG1 X40 F600\nM0\nG1 X-40\n")) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 200s)) << rig.story();
  rig.run_for(29min);
  EXPECT_NEAR(hotend(), 60, 2);
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2min)) << rig.story();
  EXPECT_NE(rig.story().find("the heaters are off: nothing has moved for 30 minutes"), std::string::npos)
      << rig.story();
  rig.run_for(60s);
  EXPECT_LT(hotend(), 55);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] < 30; }, 200s)) << rig.story();
  EXPECT_GT(hotend(), 55) << "it moves when it is hot again";
}

TEST_F(HeatOnTheBus, StopAndCancelDoWithHeatWhatTheMachineFileSays) {
  rig.machine.thermal.on_stop = rig.machine.thermal.on_cancel = ThermalDescription::After::kOff;
  rig.gateway = std::make_unique<Gateway>(rig.machine);
  ASSERT_TRUE(begin("M104 S60\nG1 X40 F600\nG1 X-40\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] > 5; }, 60s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{.why = say("STOP")}));
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 0);
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 50}));
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 0);
  EXPECT_NE(rig.story().find("STOP"), std::string::npos);
}

TEST_F(HeatOnTheBus, AnotherMasterWhoSwitchesItOffIsFoundOut) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstBed, 60}));
  rig.run_for(5s);
  ASSERT_GT(power(1), 0);
  CanFrame off{.id = cob_id::rpdo(1, kHeatId), .length = 8};
  rig.stranger_sends(off);
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  EXPECT_NE(rig.story().find("heater.bed: its node has switched it off, and not by this gateway"),
            std::string::npos)
      << rig.story();
}

TEST_F(HeatOnTheBus, ANodeThatIsNoHeatNodeIsRefused) {
  MachineRig wrong(printer_on_the_bus(), [](MachineRig::Nodes& nodes) { nodes[kHeat].heat = false; });
  ASSERT_TRUE(wrong.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(wrong.reach(MachineState::kAlarm, 30s)) << wrong.story();
  EXPECT_TRUE(wrong.told(AlarmCode::kWrongIdentity)) << wrong.story();
  EXPECT_NE(wrong.story().find("node 20: product is "), std::string::npos) << wrong.story();
}

}  // namespace
}  // namespace kinebus
