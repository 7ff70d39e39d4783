// From reset to main: memory, floating point. Runs before any constructor; touches no peripheral.

#include <cstdint>

#include "node_firmware/board/runtime.hpp"
#include "node_firmware/core/reset_report.hpp"
#include "node_firmware/port/stm32f4/handlers.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

extern "C" {

// Set by the linker script.
extern std::uint32_t data_start, data_end, data_load, bss_start, bss_end;
extern void (*init_array_start[])();
extern void (*init_array_end[])();

int main();

[[noreturn]] void reset_handler() {
  using namespace kinebus::stm32;
  system_control().CPACR = system_control().CPACR | SystemControl::kFloatingPoint;
  barrier();
  const std::uint32_t* from = &data_load;
  for (std::uint32_t* to = &data_start; to != &data_end;) *to++ = *from++;
  for (std::uint32_t* to = &bss_start; to != &bss_end;) *to++ = 0;
  for (auto* init = init_array_start; init != init_array_end; ++init) (*init)();
  main();
  kinebus::power_off_and_reset(kinebus::fault_reason::kMainEnded, nullptr);
}
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
}
