#pragma once
// Without its clock a board cannot speak: neither bus nor USB. It shows so, and tries again.

#include "node_firmware/board/runtime.hpp"
#include "node_firmware/board/status_led.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

namespace kinebus::stm32 {

/// `show(lit)`: the board's LED. On the chip's own oscillator, some 4 s.
template <typename Show>
[[noreturn]] void tell_no_clock(std::uint16_t reason, Show&& show) {
  constexpr std::uint32_t kRounds = 4, kLooks = 100'000;  // of some ten cycles: 65 ms at 16 MHz
  for (std::uint32_t step = 0; step < 16 * kRounds; ++step) {
    show(led_without_clock(step));
    static_cast<void>(wait_until([] { return (rcc().CR & Rcc::kHsiReady) == 0; }, kLooks));
  }
  power_off_and_reset(reason, nullptr);
}

}  // namespace kinebus::stm32
