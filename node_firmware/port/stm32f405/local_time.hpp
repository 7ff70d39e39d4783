#pragma once
// Local time: TIM2 counts at 4 MHz. Interrupts note its 32 bits; the main loop, which alone keeps the 64-bit
// time, makes times of them.

#include "node_firmware/port/stm32f405/board.hpp"
#include "node_firmware/port/stm32f405/registers.hpp"
#include "protocol/time.hpp"

namespace kinebus::stm32 {

inline void start_local_time() {
  rcc().APB1ENR = rcc().APB1ENR | Rcc::kTim2;
  tim2().PSC = 2 * board::kApb1Hz / board::kLocalHz - 1;
  tim2().ARR = 0xFFFF'FFFF;
  tim2().EGR = Timer::kGenerateUpdate;  // the prescaler takes effect
  tim2().CR1 = Timer::kEnable;
}
/// 250 ns a count.
inline std::uint32_t local_counts() {
  return tim2().CNT;
}

class LocalClock {
 public:
  /// Main loop only; at least every 17 minutes.
  LocalTime now() {
    counts_ += static_cast<std::uint32_t>(local_counts() - static_cast<std::uint32_t>(counts_));
    return LocalTime{counts_ * board::kLocalNs};
  }
  /// Of a count that an interrupt noted a short while ago.
  LocalTime at(std::uint32_t counts) const {
    const auto difference = static_cast<std::int32_t>(counts - static_cast<std::uint32_t>(counts_));
    return LocalTime{(counts_ + difference) * board::kLocalNs};
  }

 private:
  std::int64_t counts_ = 0;
};

}  // namespace kinebus::stm32
