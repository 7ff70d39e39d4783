#pragma once
// From the widths of the lines to the advance.

#include <string>
#include <string_view>
#include <vector>

#include "gateway/result.hpp"

namespace kinebus {

/// Of one line of the pattern: its mean widths behind the speeding up and the slowing down.
struct LineWidths {
  double advance_s = 0, faster_mm = 0, slower_mm = 0;
  double faster_near_mm = 0, slower_near_mm = 0;  ///< right behind them; 0: not measured
  bool near() const { return faster_near_mm > 0 && slower_near_mm > 0; }
};

/// A table with the columns advance_s, faster_mm, slower_mm (or _um), and, where the melt is to be found too,
/// faster_near_mm and slower_near_mm. Error: the line, and what is wrong.
Result<std::vector<LineWidths>, std::string> read_widths(std::string_view csv);
std::string write_widths(const std::vector<LineWidths>& widths);

struct PressureChoice {
  double advance_s = 0;
  double sigma_s = 0;  ///< of that, as the readings scatter
  double rms_mm = 0;   ///< of the readings about the straight line
};

/// Where the two widths are the same: filament that is missing behind the speeding up is as much as is too
/// much behind the slowing down, and both shrink in proportion to what the advance lacks. Theil and Sen's
/// line, so that a spoilt bead does not count. Error: fewer than three lines; widths that do not change with
/// the advance; a crossing beyond the lines printed (and which way to go on).
Result<PressureChoice, std::string> choose_advance(const std::vector<LineWidths>& widths);

}  // namespace kinebus
