#pragma once
// When a heater counts as hot, or cold, enough.

#include "gateway/devices/devices.hpp"

namespace kinebus {

/// Reached within the window (and not above it when cooling counts too).
struct TemperatureWait {
  HeaterId heater;
  double celsius = 0;
  double window_celsius = 1;
  bool cooling_too = false;
  bool over(const Devices& devices) const {
    const double actual = devices.heater(heater).actual_celsius;
    if (actual < celsius - window_celsius) return false;
    return !cooling_too || actual <= celsius + window_celsius;
  }
};

}  // namespace kinebus
