// What the language's run time asks of a program without an operating system: nothing but a safe end.

#include <cstddef>

#include "node_firmware/board/runtime.hpp"
#include "node_firmware/core/reset_report.hpp"

namespace {

[[noreturn]] void end(std::uint16_t reason, const void* caller) {
  kinebus::power_off_and_reset(reason, caller);
}

}  // namespace

extern "C" {
[[noreturn]] void __assert_func(const char*, int, const char*, const char*) {
  end(kinebus::fault_reason::kAssert, __builtin_return_address(0));
}
[[noreturn]] void abort() {
  end(kinebus::fault_reason::kAbort, __builtin_return_address(0));
}
[[noreturn]] void __cxa_pure_virtual() {
  end(kinebus::fault_reason::kAbort, __builtin_return_address(0));
}
// Static objects live until the power goes off.
int __aeabi_atexit(void*, void (*)(void*), void*) {
  return 0;
}
void* __dso_handle = nullptr;
}
// Virtual destructors name these, and nothing calls them: there is no heap.
void operator delete(void*) noexcept {
  end(kinebus::fault_reason::kAbort, __builtin_return_address(0));
}
void operator delete(void*, std::size_t) noexcept {
  end(kinebus::fault_reason::kAbort, __builtin_return_address(0));
}
