#pragma once
// How a tap turns the spindle back: evenly, no faster than the machine file says, gently at begin and end.

#include <algorithm>

#include "gateway/description/machine_description.hpp"

namespace kinebus {

struct TapTurn {
  static constexpr double kEase_s = 0.12;  ///< until it is braked as hard: path time follows in steps
  double turns_per_s = 0;                  ///< before and after
  double turns_per_s2 = 0;                 ///< in between

  /// `rpm`: before. Path time follows it with at most two thirds of the slope of a hold.
  TapTurn(const MachineDescription& machine, double rpm)
      : turns_per_s(rpm / 60),
        turns_per_s2(std::min(machine.spindle.tap_rpm_per_s / 60,
                              turns_per_s / (1.5e-3 * static_cast<double>(machine.stop.hold_ramp.count())))) {
  }
  /// From full speed to standing.
  double turns() const { return turns_per_s * turns_per_s / (2 * turns_per_s2) + turns_per_s * kEase_s / 2; }
};

}  // namespace kinebus
