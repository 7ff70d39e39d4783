// What the language's run time asks of a program without an operating system: nothing but a safe end.

#include <cstddef>

#include "node_firmware/port/stm32f405/handlers.hpp"
#include "node_firmware/port/stm32f405/pins.hpp"

namespace {

[[noreturn]] void power_off_and_reset() {
  using namespace kinebus;
  stm32::disable_interrupts();
  for (const board::OutputPin enable : board::kDriverEnable) stm32::write(enable, false);
  stm32::tim1().BDTR = 0;
  stm32::tim8().BDTR = 0;
  stm32::barrier();
  stm32::system_control().AIRCR = stm32::SystemControl::kResetRequest;
  for (;;) stm32::wait_for_interrupt();
}

}  // namespace

extern "C" {
void isr_fault() {
  power_off_and_reset();
}
void isr_unexpected() {
  power_off_and_reset();
}
[[noreturn]] void __assert_func(const char*, int, const char*, const char*) {
  power_off_and_reset();
}
[[noreturn]] void abort() {
  power_off_and_reset();
}
[[noreturn]] void __cxa_pure_virtual() {
  power_off_and_reset();
}
// Static objects live until the power goes off.
int __aeabi_atexit(void*, void (*)(void*), void*) {
  return 0;
}
void* __dso_handle = nullptr;
}
// Virtual destructors name these, and nothing calls them: there is no heap.
void operator delete(void*) noexcept {
  power_off_and_reset();
}
void operator delete(void*, std::size_t) noexcept {
  power_off_and_reset();
}
