// From reset to main: vectors, memory, floating point. Runs before any constructor; touches no peripheral.

#include <cstdint>

#include "node_firmware/board/runtime.hpp"
#include "node_firmware/core/reset_report.hpp"
#include "node_firmware/port/stm32f405/handlers.hpp"
#include "node_firmware/port/stm32f405/registers.hpp"

extern "C" {

// Set by the linker script.
extern std::uint32_t stack_top, data_start, data_end, data_load, bss_start, bss_end;
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

namespace {

using Handler = void (*)();
using kinebus::stm32::Irq;

struct VectorTable {
  std::uint32_t* stack;
  Handler core[15];
  Handler interrupts[kinebus::stm32::kInterruptCount];
};

constexpr VectorTable make_vectors() {
  VectorTable table{&stack_top, {}, {}};
  for (Handler& handler : table.core) handler = isr_fault;
  for (Handler& handler : table.interrupts) handler = isr_unexpected;
  table.core[0] = reset_handler;
  table.core[14] = isr_tick;
  const auto at = [&](Irq irq) -> Handler& { return table.interrupts[static_cast<int>(irq)]; };
  at(Irq::kExti0) = isr_switches;
  at(Irq::kExti1) = isr_switches;
  at(Irq::kExti3) = isr_switches;
  at(Irq::kExti4) = isr_switches;
  at(Irq::kExti9To5) = isr_switches;
  at(Irq::kExti15To10) = isr_switches;
  at(Irq::kAdc) = isr_control;
  at(Irq::kCan1Rx0) = isr_can_receive;
  at(Irq::kCan1Tx) = isr_can_transmit;
  at(Irq::kCan1Sce) = isr_can_state;
  at(Irq::kTim1Break) = isr_break_a;
  at(Irq::kTim8Break) = isr_break_b;
  at(Irq::kUsart1) = isr_console;
  return table;
}

[[gnu::section(".vectors"), gnu::used]] constinit const VectorTable kVectors = make_vectors();

}  // namespace

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
