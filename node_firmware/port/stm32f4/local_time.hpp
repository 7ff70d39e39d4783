#pragma once
// Local time: TIM2 counts at 4 MHz.

#include "node_firmware/board/local_clock.hpp"
#include "node_firmware/port/stm32f4/clocks.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

namespace kinebus::stm32 {

inline void start_local_time() {
  enable_clock(rcc().APB1ENR, Rcc::kTim2);
  tim2().PSC = 2 * kApb1Hz / kLocalHz - 1;
  tim2().ARR = 0xFFFF'FFFF;
  tim2().EGR = Timer::kGenerateUpdate;  // the prescaler takes effect
  tim2().CR1 = Timer::kEnable;
}
/// 250 ns a count.
inline std::uint32_t local_counts() {
  return tim2().CNT;
}
/// 65 ms, a step of the status LED's patterns.
inline constexpr std::uint32_t kLedStep = 1u << 18;
struct LocalTimer {
  static PlanCounts counts() { return local_counts(); }
};
static_assert(kLocalNs == kPlanCount.count());

}  // namespace kinebus::stm32
