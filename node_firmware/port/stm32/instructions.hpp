#pragma once
// Instructions that C++ has no words for, and what every chip does with them.

#include <cstdint>

#include "node_firmware/port/stm32/peripheral.hpp"

namespace kinebus::stm32 {

inline void wait_for_interrupt() {
  asm volatile("wfi" ::: "memory");
}
inline void disable_interrupts() {
  asm volatile("cpsid i" ::: "memory");
}
inline void enable_interrupts() {
  asm volatile("cpsie i" ::: "memory");
}
inline void barrier() {
  asm volatile("dsb\n isb" ::: "memory");
}

/// Clocks of peripherals on. What is written to a peripheral in the bus cycles after that may be lost
/// (ES0182, "delay after an RCC peripheral clock enabling"; RM0444: two cycles): the read back takes longer,
/// and the barrier waits for it.
inline void enable_clock(Reg& enable, std::uint32_t peripherals) {
  enable = enable | peripherals;
  [[maybe_unused]] const std::uint32_t seen = enable;
  barrier();
}

/// By AIRCR, which every Cortex-M has.
[[noreturn]] inline void reset_processor() {
  disable_interrupts();
  barrier();
  peripheral<Reg>(0xE000'ED0C) = 0x05FA'0000 | bit(2);
  for (;;) wait_for_interrupt();
}

/// Waits for a register bit, so many looks at most. False: it never came.
template <typename Condition>
bool wait_until(Condition condition, std::uint32_t looks = 2'000'000) {
  while (looks-- != 0)
    if (condition()) return true;
  return false;
}

}  // namespace kinebus::stm32
