#pragma once
// Where the handover is: the first bytes of the RAM, in boot loader and program alike (sections.ld).

#include "node_firmware/boot/handover.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

extern "C" kinebus::Handover handover_ram;

namespace kinebus::stm32 {

[[noreturn]] inline void reset_processor() {
  disable_interrupts();
  barrier();
  system_control().AIRCR = SystemControl::kResetRequest;
  for (;;) wait_for_interrupt();
}

}  // namespace kinebus::stm32
