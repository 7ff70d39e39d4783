#pragma once

namespace kinebus::stm32 {

/// Each port's own: interrupts off for good, and no motor has power when it returns. From any state of the
/// program.
void outputs_off();
/// Each port's own, before a reset: handover and fault record are where the reset leaves them.
void keep_records();

}  // namespace kinebus::stm32
