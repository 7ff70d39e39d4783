#include "gateway/run/thermal.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {

SimulatedThermal::SimulatedThermal(Options options)
    : ambient_(options.ambient_celsius),
      heaters_{State{options.hotend, options.ambient_celsius, 0},
               State{options.bed, options.ambient_celsius, 0}},
      spindle_rpm_per_s_(options.spindle_rpm_per_s) {}

void SimulatedThermal::set_target(Heater heater, double celsius) {
  heaters_[static_cast<std::size_t>(heater)].target = celsius;
}

HeaterStatus SimulatedThermal::heater(Heater heater) const {
  const State& s = heaters_[static_cast<std::size_t>(heater)];
  return {s.celsius, s.target};
}

void SimulatedThermal::on_time(BusTime now) {
  if (last_ && now > *last_) {
    const double seconds = to_seconds(now - *last_);
    for (State& state : heaters_) advance(state, seconds);
    const double most = spindle_rpm_per_s_ * seconds;
    spindle_.actual_rpm += std::clamp(spindle_.target_rpm - spindle_.actual_rpm, -most, most);
  }
  if (!last_ || now > *last_) last_ = now;
}

void SimulatedThermal::advance(State& s, double seconds) const {
  // Steps of at most a fifth of the band's own time constant keep the explicit thermostat stable.
  const double step_s = s.model.time_constant_s * s.model.band_celsius / s.model.rise_celsius / 5;
  while (seconds > 0) {
    const double dt = std::min(seconds, step_s);
    const double hold = (s.target - ambient_) / s.model.rise_celsius;
    const double power =
        s.target <= 0 ? 0 : std::clamp(hold + (s.target - s.celsius) / s.model.band_celsius, 0.0, 1.0);
    const double end = ambient_ + s.model.rise_celsius * power;
    s.celsius = end + (s.celsius - end) * std::exp(-dt / s.model.time_constant_s);
    seconds -= dt;
    // A long step at rest temperature needs no small steps.
    if (s.target <= 0 && seconds > 0) {
      s.celsius = ambient_ + (s.celsius - ambient_) * std::exp(-seconds / s.model.time_constant_s);
      seconds = 0;
    }
  }
}

bool TemperatureWait::over(const ThermalDevice& device) const {
  const double actual = device.heater(heater).actual_celsius;
  if (actual < celsius - window_celsius) return false;
  return !cooling_too || actual <= celsius + window_celsius;
}

}  // namespace kinebus
