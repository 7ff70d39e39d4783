#pragma once
// Where a kind of heater usually works: what it is measured for when nobody says otherwise.

#include <algorithm>

#include "gateway/description/device_description.hpp"

namespace kinebus {

/// deg C.
inline double usual_celsius(const HeaterDescription& heater) {
  constexpr double kHotend = 200, kBed = 80, kChamber = 70;
  const double usual = heater.kind == HeaterKind::kHotend ? kHotend
                       : heater.kind == HeaterKind::kBed  ? kBed
                                                          : kChamber;
  return std::min(usual, heater.max_c);
}

}  // namespace kinebus
