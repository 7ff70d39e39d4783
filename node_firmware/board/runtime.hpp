#pragma once

namespace kinebus {

/// A port's: no motor keeps its power, and the processor starts anew.
[[noreturn]] void power_off_and_reset();

}  // namespace kinebus
