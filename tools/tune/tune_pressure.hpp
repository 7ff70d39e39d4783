#pragma once
// The pattern printed by the simulated machine, and its lines' widths as somebody would measure them.

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "tools/simulation/nozzle.hpp"
#include "tools/tune/pressure_pattern.hpp"
#include "tools/tune/pressure_widths.hpp"

namespace kinebus {

/// Whoever measures is off by 0.01 mm rms, and reads hundredths. Error: the job came to no good end.
Result<std::vector<LineWidths>, std::string> print_simulated(const MachineDescription& machine,
                                                             const PressurePattern& pattern,
                                                             const Nozzle::Truth& truth, std::uint64_t seed);

}  // namespace kinebus
