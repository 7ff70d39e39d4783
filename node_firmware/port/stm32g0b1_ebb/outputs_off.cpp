#include "node_firmware/port/stm32/outputs_off.hpp"

#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/pins.hpp"

namespace kinebus::stm32 {

void outputs_off() {
  g0b1::disable_interrupts();
  for (const ebb::PowerPin& power : ebb::kPowerPins) g0b1::write(power.pin, power.off);
  g0b1::barrier();
}

void keep_records() {}  // RAM does

}  // namespace kinebus::stm32
