#include "vcan_tests/campaign/campaign_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "gateway/description/machine_file.hpp"
#include "vcan_tests/campaign/injector.hpp"

namespace kinebus {
namespace {

/// As HeatPlant has it.
void put_heat_on_the_bus(MachineDescription& machine) {
  constexpr std::uint8_t kId = 20;
  const auto at = [](std::uint8_t channel) { return DevicePlace{DevicePlace::Where::kNode, kId, channel}; };
  machine.nodes.push_back(
      {.id = kId,
       .vendor = {},
       .product = {},
       .serial = {},
       .functions = {
           .axis_pairs = 0, .inputs = 0, .heaters = 2, .sensors = 0, .outputs = 2, .filament_sensors = 2}});
  machine.thermal.min_extrude_c = 150;
  for (HeaterDescription& heater : machine.heaters) {
    const bool bed = heater.kind == HeaterKind::kBed;
    heater.place = at(bed ? 2 : 1);
    heater.max_c = bed ? 60 : 200;
    heater.wiring = {.sensor = {.element = SensorElement::kBeta},
                     .power_w = bed ? 250.0 : 44.0,
                     .rise = std::chrono::seconds{bed ? 60 : 20},
                     .safe_c = bed ? 40.0 : 0.0,
                     .safe_time = std::chrono::seconds{bed ? 20 : 0},
                     .fan_channel = static_cast<std::uint8_t>(bed ? 0 : 1),
                     .fan_pulses = 2};
  }
  machine.fans[0].place = at(2);
  machine.filament_sensors = {{.name = "feeder", .kind = FilamentSensorKind::kMotion, .place = at(2)},
                              {.name = "spool", .kind = FilamentSensorKind::kSwitch, .place = at(1)}};
}

}  // namespace

std::string campaign_job(std::uint64_t seed, FaultKind kind) {
  const bool heats = of_heat(kind);
  std::mt19937_64 random(seed ^ 0xA5A5);
  const auto in = [&](double low, double high) { return low + (high - low) * unit(random); };
  std::string text = heats ? "M140 S45\nM109 S185\n" : "";
  text += "G21 G90 M83\nG1 Z20 F9000\nG43.4\n";
  const int most = heats ? 400 : 60;
  const double far = heats ? 1500 : 260;
  double x = 0, y = 0, way = 0;
  for (int i = 0; i < most && way < far; ++i) {
    const double length = std::exp(in(std::log(0.05), std::log(50))), angle = in(0, 6.2832);
    x = std::clamp(x + length * std::cos(angle), -50.0, 50.0);
    y = std::clamp(y + length * std::sin(angle), -50.0, 50.0);
    way += length;
    if (random() % 4 == 0)
      text += fmt::format("G1 X{:.3f} Y{:.3f} Z{:.3f} A{:.2f} C{:.2f} E{:.4f} F{:.0f}\n", x, y, in(15, 40),
                          in(-12, 12), in(-90, 90), 0.03 * length, in(3000, 12000));
    else
      text += fmt::format("G1 X{:.3f} Y{:.3f} E{:.4f} F{:.0f}\n", x, y, 0.03 * length, in(3000, 15000));
  }
  return text;
}

MachineDescription campaign_machine(FaultKind kind) {
  MachineDescription machine = default_m1();
  for (NodeDescription& node : machine.nodes) node.product = 0x4B42;
  for (NodeDescription& node : machine.nodes)
    node.inputs[kEmergencyInput - 1].function = InputFunction::kEmergencyStop;
  if (of_heat(kind)) put_heat_on_the_bus(machine);
  return machine;
}

}  // namespace kinebus
