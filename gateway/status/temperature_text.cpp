#include "gateway/status/temperature_text.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace kinebus {
namespace {

std::string temperature_of(const std::string& letter, const HeaterStatus& heater) {
  return letter + printed(":%.2f /%.2f ", heater.actual_celsius, heater.target_celsius);
}

}  // namespace

std::string temperature_text(const MachineStatus& status) {
  const auto is = [](HeaterKind kind) {
    return [kind](const NamedHeaterStatus& h) { return h.id.kind == kind; };
  };
  const auto& all = status.heaters;
  std::string text =
      temperature_of("T", status.heater(status.tool)) + temperature_of("B", status.heater(kFirstBed));
  if (const auto chamber = std::find_if(all.begin(), all.end(), is(HeaterKind::kChamber));
      chamber != all.end())
    text += temperature_of("C", *chamber);
  if (std::count_if(all.begin(), all.end(), is(HeaterKind::kHotend)) > 1)
    for (const NamedHeaterStatus& h : all)
      if (h.id.kind == HeaterKind::kHotend) text += temperature_of("T" + std::to_string(h.id.index), h);
  const auto power = [&status](HeaterId id) {
    constexpr double kMarlinFull = 127;
    return std::lround(kMarlinFull * std::clamp(status.heater(id).power.value_or(0), 0.0, 1.0));
  };
  return text + "@:" + std::to_string(power(status.tool)) + " B@:" + std::to_string(power(kFirstBed));
}

}  // namespace kinebus
