#pragma once

namespace kinebus::stm32 {

/// Each port's own: interrupts off for good, and no motor has power when it returns. From any state of the
/// program.
void outputs_off();

}  // namespace kinebus::stm32
