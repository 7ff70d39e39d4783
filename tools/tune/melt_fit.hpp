#pragma once
// From the widths right behind a change of speed to the melt's time constant.

#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "tools/tune/pressure_pattern.hpp"
#include "tools/tune/pressure_widths.hpp"

namespace kinebus {

struct MeltChoice {
  double advance_s = 0;  ///< where such a melt's lines have the widths measured
  double melt_s = 0;
  double sigma_s = 0;  ///< of that, as the readings scatter
};

/// Flow follows the pressure late: a line is thin right behind the speeding up and thick right behind the
/// slowing down, though no filament is missing in the end. The pattern as `machine` plans it feeds a melt of
/// second order, of an advance and T: those whose lines are as uneven as the ones measured. advance_s: by the
/// mean widths (`choose_advance`); the lines nearest to it count. Error: no widths near the changes of speed;
/// a machine that cannot print the pattern; widths that no T between 0.5 and 60 ms explains.
Result<MeltChoice, std::string> choose_melt(const MachineDescription& machine, const PressurePattern& pattern,
                                            const std::vector<LineWidths>& widths, double advance_s);

/// The shortest window (s, whole ms, 6 ms or more) in which beads of the pattern still accelerate as the tool
/// may: a shorter one would slow the print down. Not above the window that the machine has.
double shortest_window_s(const MachineDescription& machine, const PressurePattern& pattern);

}  // namespace kinebus
