// What the language's run time asks of a program without an operating system: nothing but a safe end.

#include <cstddef>

#include "node_firmware/board/runtime.hpp"

using kinebus::power_off_and_reset;

extern "C" {
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
