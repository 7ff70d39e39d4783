// From reset to main: memory. Runs before any constructor; touches no peripheral. And what ends in a reset:
// exceptions of the core, interrupts that nobody handles, failed asserts. First nothing has power, then the
// reason is recorded.

#include <cstdint>

#include "node_firmware/board/fault_record.hpp"
#include "node_firmware/board/runtime.hpp"
#include "node_firmware/port/stm32f4/handlers.hpp"
#include "node_firmware/port/stm32f4/outputs_off.hpp"
#include "node_firmware/port/stm32g0b1_ebb/reset_port.hpp"

extern "C" {
// Set by the linker script.
extern std::uint32_t data_start, data_end, data_load, bss_start, bss_end, stack_bottom, stack_top;
extern void (*init_array_start[])();
extern void (*init_array_end[])();

int main();

[[noreturn]] void reset_handler() {
  const std::uint32_t* from = &data_load;
  for (std::uint32_t* to = &data_start; to != &data_end;) *to++ = *from++;
  for (std::uint32_t* to = &bss_start; to != &bss_end;) *to++ = 0;
  for (auto* init = init_array_start; init != init_array_end; ++init) (*init)();
  main();
  kinebus::power_off_and_reset(kinebus::fault_reason::kMainEnded, nullptr);
}
}

namespace kinebus {
namespace {

[[noreturn]] void leave(FaultRecord& record) {
  record.seal();
  fault_ram = record;
  g0b1::reset_processor();
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
/// `frame`: r0 to r3, r12, lr, pc, psr, as the core has put them on the stack, when that is one. This core
/// has no registers that tell more of a fault.
[[noreturn, gnu::used]] void record_exception(const std::uint32_t* frame) {
  using namespace kinebus;
  stm32::outputs_off();
  FaultRecord record{.reason = g0b1::system_control().ICSR & 0x3F, .sp = address_of(frame)};
  if (frame >= &stack_bottom && frame + 8 <= &stack_top) {
    record.r = {frame[0], frame[1], frame[2], frame[3]};
    record.r12 = frame[4];
    record.lr = frame[5];
    record.pc = frame[6];
    record.psr = frame[7];
  }
  leave(record);
}

// A stack that has run over is none to stand on.
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
