// What ends in a reset: exceptions of the core, interrupts that nobody handles, failed asserts.

#include "node_firmware/board/runtime.hpp"
#include "node_firmware/port/stm32f405/handlers.hpp"
#include "node_firmware/port/stm32f405/pins.hpp"

namespace kinebus {

void power_off_and_reset() {
  stm32::disable_interrupts();
  for (const board::OutputPin enable : board::kDriverEnable) stm32::write(enable, false);
  stm32::tim1().BDTR = 0;
  stm32::tim8().BDTR = 0;
  stm32::barrier();
  stm32::system_control().AIRCR = stm32::SystemControl::kResetRequest;
  for (;;) stm32::wait_for_interrupt();
}

}  // namespace kinebus

extern "C" {
void isr_fault() {
  kinebus::power_off_and_reset();
}
void isr_unexpected() {
  kinebus::power_off_and_reset();
}
}
