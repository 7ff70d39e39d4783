#pragma once
// A printer whose heat is on the bus: gateway core, axis nodes, a heat node with its plant, in virtual time.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/tests/machine_rig.hpp"
#include "node_firmware/heat/heat_node.hpp"

namespace kinebus {

inline constexpr std::uint8_t kHeatId = 20;
inline constexpr int kHeat = 3;  // its place among the nodes

/// M1, with hot end, bed and the part's fan on node 20, as HeatPlant has them.
inline MachineDescription printer_on_the_bus() {
  MachineDescription machine = default_m1();
  machine.nodes.push_back(
      {.id = kHeatId,
       .vendor = {},
       .product = {},
       .serial = {},
       .functions = {.axis_pairs = 0, .inputs = 0, .heaters = 2, .sensors = 1, .outputs = 2}});
  const SensorWiring thermistor{.element = SensorElement::kBeta};
  for (HeaterDescription& heater : machine.heaters) {
    const bool bed = heater.kind == HeaterKind::kBed;
    heater.place = {DevicePlace::Where::kNode, kHeatId, static_cast<std::uint8_t>(bed ? 2 : 1)};
    heater.wiring.sensor = thermistor;
    heater.wiring.power_w = bed ? 250 : 44;
    heater.wiring.rise = std::chrono::seconds{bed ? 60 : 20};
    heater.wiring.safe_c = bed ? 40 : 0;
    heater.wiring.safe_time = std::chrono::seconds{bed ? 20 : 0};
    heater.wiring.fan_channel = bed ? 0 : 1;
    heater.wiring.fan_pulses = 2;
  }
  machine.nodes[2].inputs[6] = {InputFunction::kEmergencyStop, 0};
  machine.fans[0].place = {DevicePlace::Where::kNode, kHeatId, 2};
  machine.sensors.push_back(
      {.name = "chamber", .place = {DevicePlace::Where::kNode, kHeatId, 1}, .wiring = thermistor});
  return machine;
}

/// Off the programmed line, mm: the motors as they really stand.
inline constexpr double kOnTheLine = 2e-3;

class HeatPrinter : public testing::Test {
 protected:
  explicit HeatPrinter(MachineDescription machine = printer_on_the_bus()) : rig(std::move(machine)) {}
  /// Where the motors have the tool, Frame::kMachine.
  Pose tool() {
    Pose pose = kinematics->bed_reference();
    static_cast<void>(kinematics->forward(Frame::kMachine, rig.joints(), pose));
    return pose;
  }
  double hotend() { return rig.gateway->status().heater(kFirstHotend).actual_celsius; }
  double bed() { return rig.gateway->status().heater(kFirstBed).actual_celsius; }
  /// Of full power.
  double power(int heater) {
    return rig.nodes.heat_node(kHeat).heater_output(heater) / static_cast<double>(heat::kFullPower);
  }
  std::string breaks(std::string_view what) { return rig.nodes.heat_plant(kHeat).command(what); }
  bool begin(std::string job) {
    return rig.make_ready() &&
           rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(std::move(job)), "part"});
  }

  MachineRig rig;
  std::unique_ptr<Kinematics> kinematics = std::move(*make_kinematics(rig.machine));
};

}  // namespace kinebus
