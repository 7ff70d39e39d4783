#include "node_firmware/port/stm32/outputs_off.hpp"

#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f405/board.hpp"

namespace kinebus::stm32 {

void outputs_off() {
  disable_interrupts();
  for (const OutputPin enable : board::kDriverEnable) write(enable, false);
  tim1().BDTR = 0;
  tim8().BDTR = 0;
  barrier();
}

void keep_records() {}  // RAM does

}  // namespace kinebus::stm32
