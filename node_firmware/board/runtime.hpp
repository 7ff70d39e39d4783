#pragma once

#include <cstdint>

namespace kinebus {

/// A port's: no motor keeps its power, `reason` (fault_reason) and `place` in the program are recorded, and
/// the processor starts anew.
[[noreturn]] void power_off_and_reset(std::uint16_t reason, const void* place);

}  // namespace kinebus
