#pragma once
// Temperatures the way that print hosts read them.

#include <string>

#include "gateway/status/status.hpp"

namespace kinebus {

/// "T:205.00 /210.00 B:60.00 /60.00 @:64 B@:127" as Marlin answers M105, power of 127; with several hot ends
/// T0:, T1: ... too, with a chamber C:.
std::string temperature_text(const MachineStatus& status);

}  // namespace kinebus
