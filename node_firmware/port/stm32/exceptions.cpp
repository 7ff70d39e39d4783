// What ends in a reset: exceptions of the core, interrupts that nobody handles, failed asserts. First nothing
// has power, then the reason is recorded.

#include "node_firmware/port/stm32/exceptions.hpp"

#include "node_firmware/board/runtime.hpp"
#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32/instructions.hpp"
#include "node_firmware/port/stm32/outputs_off.hpp"

extern "C" {
extern std::uint32_t stack_bottom, stack_top;  // set by the linker script
extern kinebus::FaultRecord fault_ram;
}

namespace kinebus {
namespace {

[[noreturn]] void leave(FaultRecord& record) {
  record.seal();
  fault_ram = record;
  stm32::keep_records();
  stm32::reset_processor();
}

std::uint32_t address_of(const void* place) {
  return reinterpret_cast<std::uintptr_t>(place);
}

}  // namespace

void power_off_and_reset(std::uint16_t reason, const void* place) {
  stm32::outputs_off();
  FaultRecord record{.reason = reason, .pc = address_of(place)};
  leave(record);
}

}  // namespace kinebus

extern "C" {
/// `frame`: r0 to r3, r12, lr, pc, psr, as the core has put them on the stack, when that is one.
[[noreturn, gnu::used]] void record_exception(const std::uint32_t* frame) {
  using namespace kinebus;
  stm32::outputs_off();
  FaultRecord record{.sp = address_of(frame)};
  stm32::record_core(record);
  if (frame >= &stack_bottom && frame + 8 <= &stack_top) {
    record.r = {frame[0], frame[1], frame[2], frame[3]};
    record.r12 = frame[4];
    record.lr = frame[5];
    record.pc = frame[6];
    record.psr = frame[7];
  }
  leave(record);
}

// A stack that has run over is none to stand on. Far branches by a register: a Cortex-M0+ has no others.
[[gnu::naked]] void isr_fault() {
  asm volatile(
      "mov r0, sp\n"
      "ldr r1, =stack_bottom + 256\n"
      "cmp r0, r1\n"
      "bhs 1f\n"
      "ldr r1, =stack_top\n"
      "mov sp, r1\n"
      "1: ldr r1, =record_exception\n"
      "bx r1\n");
}
[[gnu::naked]] void isr_unexpected() {
  asm volatile("ldr r0, =isr_fault\n bx r0\n");
}
}
