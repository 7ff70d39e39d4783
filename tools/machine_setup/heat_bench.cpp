#include "tools/machine_setup/heat_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/bus_nodes/node_configuration.hpp"
#include "protocol/canopen/nmt.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// Within the five seconds after which a node without a master lets go.
constexpr LocalTime kLook = 200ms;
/// A sensor that was just described has measured by then.
constexpr LocalTime kFirstMeasurement = 1500ms;
/// 1000h to 1FFFh: heartbeats of a gateway that is not there.
constexpr std::uint16_t kFirstOfManufacturer = 0x2000;
constexpr std::int64_t kFullFan = 0x7FFF;

}  // namespace

std::int64_t HeatBench::read(ObjectAddress first, int n) {
  return node_.read({first.index, static_cast<std::uint8_t>(first.subindex + n)});
}

void HeatBench::write(ObjectAddress first, int n, std::int64_t value) {
  node_.write({first.index, static_cast<std::uint8_t>(first.subindex + n)}, value);
}

void HeatBench::describe(const MachineDescription& machine, bool fans_free) {
  node_.send(nmt_frame(NmtCommand::kEnterPreOperational, node_.node()));
  const NodeConfiguration configuration = configure_node(machine, node_.node());
  for (const auto* writes : {&configuration.before, &configuration.writes})
    for (const ParameterWrite& one : *writes)
      if (one.address.index >= kFirstOfManufacturer) node_.write(one.address, one.value);
  if (fans_free)
    for (int fan = 0; fan < kFans; ++fan) write(heat_object::kFanFunction, fan, 0);
  node_.write(heat_object::kConfirmedSerial, node_.read({object::kVendorIdentity.index, 4}));
  node_.send(nmt_frame(NmtCommand::kStart, node_.node()));
  node_.pause(kFirstMeasurement);
}

std::optional<double> HeatBench::temperature_c(int sensor) {
  if (read(heat_object::kInputStatus, sensor) != 0) return std::nullopt;
  return static_cast<double>(read(heat_object::kInputI16, sensor)) / 10;
}

std::string HeatBench::sensor_trouble(int sensor, const SensorWiring& wiring) {
  constexpr std::int64_t kAbove = 2, kBelow = 4;  // 6150h, besides "not valid"; a thermistor's ohms fall
  const auto status = read(heat_object::kInputStatus, sensor);
  if (status == 0) return "";
  if ((status & (wiring.is_thermistor() ? kBelow : kAbove)) != 0)
    return "nothing is plugged in there, a wire is broken, or another kind of sensor is plugged in";
  if ((status & (kAbove | kBelow)) != 0)
    return "its wires touch each other or ground, or another kind of sensor is plugged in";
  return wiring.max31865 ? "its amplifier does not answer: has this board one, a chip MAX31865?"
                         : "what it says cannot be true: is its plug loose?";
}

HeatBench::Rise HeatBench::warm(int heater, const Limits& limits, const std::function<bool()>& stop) {
  std::array<std::optional<double>, kHeatSensors> begin;
  for (int i = 0; i < kHeatSensors; ++i) begin[static_cast<std::size_t>(i)] = temperature_c(i);
  const auto own = static_cast<std::size_t>(heater);
  Rise rise;
  if (!begin[own]) return rise.trouble = "its sensor does not measure: is it plugged in, and whole?", rise;
  if (*begin[own] > limits.warmest_begin_c)
    return rise.trouble = fmt::format("it is at {:.1f} C: let it cool below {:.0f} C first", *begin[own],
                                      limits.warmest_begin_c),
           rise;
  // A fault stays until somebody has looked: who asks for another try has.
  if (read(heat_object::kHeaterFault, heater) != 0) write(heat_object::kFaultReset, heater, 1);
  write(heat_object::kSetPoint, heater, std::llround(10 * (*begin[own] + limits.rise_k)));
  for (const LocalTime end = node_.now() + limits.time; node_.now() < end;) {
    node_.pause(kLook);
    if (stop()) {
      rise.trouble = "interrupted";
      break;
    }
    for (std::size_t i = 0; i < begin.size(); ++i) {
      const auto now = begin[i] ? temperature_c(static_cast<int>(i)) : std::nullopt;
      if (now) rise.rise_k[i] = std::max(rise.rise_k[i], *now - *begin[i]);
    }
    if (const auto fault = read(heat_object::kHeaterFault, heater); fault != 0) {
      rise.trouble = fmt::format("the node has taken its power: fault {:04X}h", static_cast<unsigned>(fault));
      break;
    }
    const double most = *std::max_element(rise.rise_k.begin(), rise.rise_k.end());
    rise.reached = rise.rise_k[own] >= limits.rise_k - 0.5;
    if (rise.reached) break;
    if (most >= limits.rise_k) break;  // another sensor
    if (most > limits.most_rise_k) break;
  }
  write(heat_object::kSetPoint, heater, 0);
  const auto warmest = std::max_element(rise.rise_k.begin(), rise.rise_k.end());
  if (*warmest > limits.rise_k / 3) rise.warmest = static_cast<int>(warmest - rise.rise_k.begin());
  return rise;
}

void HeatBench::run_fan(int fan, bool on) {
  write(heat_object::kFanOutput, fan, on ? kFullFan : 0);
}

}  // namespace kinebus
