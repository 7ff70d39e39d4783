// The first instructions after a reset, what the core tells of a fault, and the one exception that may go on.

#include "node_firmware/port/stm32/startup.hpp"

#include "node_firmware/port/stm32/exceptions.hpp"
#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32g0b1_ebb/registers.hpp"

extern "C" [[noreturn]] void reset_handler() {
  kinebus::stm32::run_program();
}

/// This core has no registers that tell more of a fault.
void kinebus::stm32::record_core(FaultRecord& record) {
  record.reason = g0b1::system_control().ICSR & 0x3F;
}

// What a program has no handler for. It may lie anywhere: a branch reaches 2 KiB.
extern "C" {
[[gnu::weak, gnu::naked]] void isr_tick() {
  asm("ldr r0, =isr_unexpected\n bx r0");
}
[[gnu::weak, gnu::naked]] void isr_switches() {
  asm("ldr r0, =isr_unexpected\n bx r0");
}
[[gnu::weak, gnu::naked]] void isr_control() {
  asm("ldr r0, =isr_unexpected\n bx r0");
}
}

extern "C" {
/// 1: a double word of flash that cannot be right, as a power cut leaves while it is written: whoever reads
/// it has a CRC. 0: the crystal has stopped.
[[gnu::used]] int forget_flash_error() {
  using namespace kinebus::g0b1;
  constexpr std::uint32_t kDetected = std::uint32_t{1} << 31;
  const bool detected = (flash_interface().ECCR & kDetected) != 0;
  if (detected) flash_interface().ECCR = kDetected;
  return detected ? 1 : 0;
}
[[gnu::naked]] void isr_nmi() {
  asm volatile(
      "push {r4, lr}\n"
      "bl forget_flash_error\n"
      "cmp r0, #0\n"
      "beq 1f\n"
      "pop {r4, pc}\n"
      "1: pop {r0, r1}\n"
      "mov lr, r1\n"
      "ldr r1, =isr_fault\n"
      "bx r1\n");
}
}
