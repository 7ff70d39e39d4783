// The first instructions after a reset, and what the core tells of a fault.

#include "node_firmware/port/stm32/startup.hpp"

#include "node_firmware/port/stm32/exceptions.hpp"
#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

extern "C" [[noreturn]] void reset_handler() {
  using namespace kinebus::stm32;
  system_control().CPACR = system_control().CPACR | SystemControl::kFloatingPoint;
  barrier();
  run_program();
}

void kinebus::stm32::record_core(FaultRecord& record) {
  const SystemControl& core = system_control();
  record.reason = core.ICSR & 0x1FF;
  record.cfsr = core.CFSR;
  record.hfsr = core.HFSR;
  record.address = core.BFAR;
}

// What a program does not use falls back to these: a branch, so that the stack is as the exception left it.
extern "C" {
[[gnu::weak, gnu::naked]] void isr_tick() {
  asm volatile("b isr_unexpected");
}
[[gnu::weak, gnu::naked]] void isr_switches() {
  asm volatile("b isr_unexpected");
}
[[gnu::weak, gnu::naked]] void isr_control() {
  asm volatile("b isr_unexpected");
}
[[gnu::weak, gnu::naked]] void isr_can_receive() {
  asm volatile("b isr_unexpected");
}
[[gnu::weak, gnu::naked]] void isr_can_transmit() {
  asm volatile("b isr_unexpected");
}
[[gnu::weak, gnu::naked]] void isr_can_state() {
  asm volatile("b isr_unexpected");
}
[[gnu::weak, gnu::naked]] void isr_break_a() {
  asm volatile("b isr_unexpected");
}
[[gnu::weak, gnu::naked]] void isr_break_b() {
  asm volatile("b isr_unexpected");
}
[[gnu::weak, gnu::naked]] void isr_console() {
  asm volatile("b isr_unexpected");
}
[[gnu::weak, gnu::naked]] void isr_usb() {
  asm volatile("b isr_unexpected");
}
}
