#pragma once
// Which shaper, for which frequency, and how fast one may go with it.

#include <optional>
#include <string_view>
#include <vector>

#include "gateway/shaping/input_shaper.hpp"
#include "tools/tune/vibration_fit.hpp"

namespace kinebus {

struct ShaperRating {
  ShaperKind kind = ShaperKind::kNone;
  double frequency_hz = 0, damping_ratio = 0;  ///< for the machine file
  double left = 1;  ///< of the vibration of a corner, with the frequencies 10 % off and all overrides: worst
  double left_as_measured = 1;  ///< with the frequencies as they were found, at full rate
  double deviation_mm = 0;      ///< off the path, at the machine's acceleration
  double accel_mm_per_s2 = 0;   ///< that keeps to the deviation asked for
};

struct ShaperQuestion {
  std::vector<std::vector<FittedMode>> axes;  ///< that shall share one shaper
  double accel_mm_per_s2 = 0;                 ///< the machine's
  double deviation_mm = 0;                    ///< allowed by shaping; 0: the machine's acceleration counts
  double slowest_rate = 0;                    ///< VibrationDescription
};

inline constexpr double kMostLeft = 0.05;

/// All shapers, ZV first.
std::vector<ShaperRating> rate_shapers(const ShaperQuestion& question);
/// Of those that leave at most kMostLeft the one that rounds corners least; where there is none, the one that
/// leaves least.
const ShaperRating& best_shaper(const std::vector<ShaperRating>& ratings);

/// Vibration that a shaper leaves of what a step of the acceleration starts, to unshaped: all modes together,
/// each by how far it swings; the frequencies are `error` times those found.
double vibration_left(const InputShaper& shaper, const std::vector<FittedMode>& modes, double error);

/// As in the machine file.
std::string_view shaper_name(ShaperKind kind);

}  // namespace kinebus
