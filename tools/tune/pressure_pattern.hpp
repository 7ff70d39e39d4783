#pragma once
// Lines printed slow, fast and slow again, each with another pressure advance: where their width is even, it
// is right.

#include <string>
#include <vector>

#include "gateway/result.hpp"

namespace kinebus {

struct PressurePattern {
  double from_s = 0, to_s = 0.1;
  int lines = 11;
  double slow_mm_per_s = 20, fast_mm_per_s = 100;
  double width_mm = 0.45, height_mm = 0.2, filament_mm = 1.75;
  double x_mm = 0, y_mm = 0;  ///< its middle
  double slow_part_mm = 18, fast_part_mm = 40, pitch_mm = 5;
  double hotend_celsius = 0, bed_celsius = 0;  ///< 0: as they are
  double retract_mm = 0.8, retract_mm_per_s = 35;

  double advance_s(int line) const;
  double filament_per_mm() const;
  double left_mm() const { return x_mm - slow_part_mm - 0.5 * fast_part_mm; }
  double speeds_up_mm() const { return left_mm() + slow_part_mm; }
  double slows_down_mm() const { return speeds_up_mm() + fast_part_mm; }
  double line_y_mm(int line) const { return y_mm + pitch_mm * (line - 0.5 * (lines - 1)); }
};

/// Over this length behind the start of a change of speed a width is a mean.
inline constexpr double kWidthOver_mm = 8;
/// Over this length where the speed itself changes, as melt that follows late shows: behind the end of the
/// slow part, in which the corner of two lines in one direction is passed, and before that of the fast one.
inline constexpr double kNear_mm = 3, kNearBehind_mm = 1.5, kNearBefore_mm = 4;
/// Before the end of the fast part, where the tool already brakes.
inline constexpr double kBrakes_mm = 2;

/// Error: what is wrong with the values, in words.
Result<void, std::string> check(const PressurePattern& pattern);
/// The job: a line to prime, then the lines from below upwards, advance rising.
std::string pattern_job(const PressurePattern& pattern);
/// How to read it (SVG): what too little, right and too much look like, and where to measure.
std::string draw_pattern(const PressurePattern& pattern);

}  // namespace kinebus
