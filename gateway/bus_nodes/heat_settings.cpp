#include "gateway/bus_nodes/heat_settings.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/canopen/heat_objects.hpp"

namespace kinebus {
namespace {

using namespace heat_object;

static_assert(kHeatNodeHeaters == kHeaters && kHeatNodeSensors == kHeatSensors && kHeatNodeOutputs == kFans &&
              kHeatNodeFilaments == kFilamentSensors);

/// Colder, a sensor is not believed.
constexpr double kColdest_c = -20;
/// So much above the limit a sensor is still believed: the limit is what ends the heating, not the table.
constexpr double kSensorMargin_c = 20;
constexpr double kHottestSensor_c = 350;

class Settings {
 public:
  explicit Settings(std::vector<ParameterWrite>& writes) : writes_(writes) {}
  /// `n`: 0 .. of an array whose first entry is `first`.
  void set(ObjectAddress first, std::size_t n, double value) {
    const ObjectAddress address{first.index, static_cast<std::uint8_t>(first.subindex + n)};
    const int place = kHeatTable.find(address);
    if (place < 0) return;
    writes_.push_back({address, kHeatObjects[static_cast<std::size_t>(place)].size(), std::llround(value)});
  }

 private:
  std::vector<ParameterWrite>& writes_;
};

double tenths(double celsius) {
  return 10 * celsius;
}

/// All but its type, which switches it on.
void describe(Settings& settings, std::size_t n, const SensorWiring& sensor, double limit_c) {
  settings.set(kSensorPath, n, sensor.max31865 ? 1 : 0);
  settings.set(kReference, n, 1000 * sensor.reference_ohm);
  // A node that has none may not know of it, nor of the mains.
  if (sensor.max31865) settings.set(kSensorWires, n, sensor.wires);
  settings.set(kNominalResistance, n, 1000 * sensor.nominal_ohm);
  settings.set(kBeta, n, sensor.beta_k);
  if (sensor.element == SensorElement::kPoints) {
    constexpr std::array kCelsius{kPointTemperature1, kPointTemperature2, kPointTemperature3};
    constexpr std::array kResistance{kPointResistance1, kPointResistance2, kPointResistance3};
    for (std::size_t i = 0; i < kCelsius.size(); ++i) {
      settings.set(kCelsius[i], n, tenths(sensor.points_c[i]));
      settings.set(kResistance[i], n, 1000 * sensor.points_ohm[i]);
    }
  }
  settings.set(kLowestPlausible, n, tenths(kColdest_c));
  settings.set(kHighestPlausible, n, tenths(std::max(kHottestSensor_c, limit_c + kSensorMargin_c)));
}

void describe(Settings& settings, std::size_t n, const HeaterDescription& heater) {
  const HeaterWiring& w = heater.wiring;
  settings.set(kHeaterSensor, n, static_cast<double>(n + 1));
  settings.set(kLimit, n, tenths(w.limit_for(heater.max_c)));
  settings.set(kHighestSetPoint, n, tenths(heater.max_c));
  settings.set(kOutputKind, n, w.relay ? 1 : 0);
  settings.set(kNominalPower, n, 1000 * w.power_w);
  settings.set(kNominalSupply, n, 1000 * w.supply_v);
  settings.set(kRiseTime, n, static_cast<double>(w.rise.count()));
  settings.set(kSafeSetPoint, n, tenths(w.safe_c));
  settings.set(kSafeTime, n, static_cast<double>(w.safe_time.count()));
}

void describe(Settings& settings, std::size_t n, const FilamentSensorDescription& filament) {
  settings.set(kFilamentKind, n, static_cast<double>(filament.kind));
  settings.set(kFilamentInverted, n, filament.inverted ? 1 : 0);
  settings.set(kFilamentPerEdge, n, 1000 * filament.mm_per_edge);
  settings.set(kFilamentStands, n, 1000 * filament.stands_mm);
  settings.set(kFilamentSlips, n, 1000 * filament.slips_mm);
  settings.set(kFilamentLeast, n, 100 * filament.least_share);
}

}  // namespace

void add_heat_settings(const MachineDescription& machine, std::uint8_t node_id,
                       NodeConfiguration& configuration) {
  const NodeDescription* node = machine.node(node_id);
  const auto here = [node_id](const DevicePlace& place) {
    return place.on_node() && place.node_id == node_id && place.channel > 0;
  };
  configuration.product = HeatBoard::kFacts.product_code;
  // Settings are taken while nothing heats, and no heater has another's sensor meanwhile.
  Settings before(configuration.before), settings(configuration.writes);
  for (std::size_t n = 0; n < kHeaters; ++n) before.set(kSetPoint, n, 0);
  for (std::size_t n = 0; n < kHeatSensors; ++n) before.set(kSensorType, n, 0);
  for (std::size_t n = 0; n < kHeaters; ++n) before.set(kHeaterSensor, n, 0);

  std::array<const SensorWiring*, kHeatSensors> sensors{};
  std::array<bool, kHeaters> used{};
  std::array<const HeaterDescription*, kFans> cools{};
  // Where several melt filament, the one in use is told as it changes.
  if (machine.hotends_on(node_id) <= 1) {
    const auto melts = std::find_if(
        machine.heaters.begin(), machine.heaters.end(),
        [&here](const HeaterDescription& h) { return h.kind == HeaterKind::kHotend && here(h.place); });
    settings.set(kFlowHeater, 0, melts != machine.heaters.end() ? melts->place.channel : 1);
  }
  settings.set(kMasterLost, 0, static_cast<double>(machine.thermal.gateway_lost.count()));
  for (const HeaterDescription& heater : machine.heaters) {
    if (!here(heater.place) || heater.place.channel > kHeaters) continue;
    const std::size_t n = heater.place.channel - 1u;
    used[n] = true;
    describe(settings, n, heater);
    describe(settings, n, heater.wiring.sensor, heater.wiring.limit_for(heater.max_c));
    sensors[n] = &heater.wiring.sensor;
    if (const std::uint8_t fan = heater.wiring.fan_channel; fan > 0 && fan <= kFans)
      cools[fan - 1u] = &heater;
  }
  for (std::size_t n = 0; n < kHeaters; ++n)
    if (!used[n]) settings.set(kHeaterSensor, n, 0);
  for (const SensorDescription& sensor : machine.sensors) {
    const std::size_t n = sensor.place.channel + std::size_t{node->functions.heaters} - 1;
    if (!here(sensor.place) || n >= kHeatSensors) continue;
    describe(settings, n, sensor.wiring, 0);
    sensors[n] = &sensor.wiring;
  }
  std::array<const FilamentSensorDescription*, kFilamentSensors> filaments{};
  for (const FilamentSensorDescription& filament : machine.filament_sensors)
    if (here(filament.place) && filament.place.channel <= kFilamentSensors)
      filaments[filament.place.channel - 1u] = &filament;
  for (std::size_t n = 0; n < kFilamentSensors; ++n)
    if (filaments[n] != nullptr)
      describe(settings, n, *filaments[n]);
    else
      settings.set(kFilamentKind, n, 0);
  settings.set(kPinProbe, 0, machine.probe.bltouch && machine.probe.servo_node == node_id ? 1 : 0);
  // What is no fan is dimmed as it is told: it neither needs a kick nor stands below some power.
  std::array<const FanDescription*, kFans> fans{};
  for (const FanDescription& fan : machine.fans)
    if (here(fan.place) && fan.place.channel <= kFans) fans[fan.place.channel - 1u] = &fan;
  for (const OutputDescription& output : machine.outputs)
    if (here(output.place) && output.place.channel <= kFans) {
      settings.set(kFanKick, output.place.channel - 1u, 0);
      settings.set(kFanLeast, output.place.channel - 1u, 0);
    }
  for (std::size_t n = 0; n < kFans; ++n) {
    if (fans[n] != nullptr) {
      settings.set(kFanKick, n, static_cast<double>(fans[n]->kick.count()));
      settings.set(kFanLeast, n, fans[n]->least_percent);
    }
    settings.set(kFanFunction, n, cools[n] != nullptr ? 1 : 0);
    if (cools[n] == nullptr) continue;
    settings.set(kFanHeater, n, cools[n]->place.channel);
    settings.set(kFanPulses, n, cools[n]->wiring.fan_pulses);
  }
  if (std::any_of(sensors.begin(), sensors.end(), [](const auto* s) { return s != nullptr && s->max31865; }))
    settings.set(kMains, 0, machine.thermal.mains_hz);
  for (std::size_t n = 0; n < kHeatSensors; ++n)
    settings.set(kSensorType, n, sensors[n] == nullptr ? 0 : static_cast<double>(sensors[n]->element));
}

}  // namespace kinebus
