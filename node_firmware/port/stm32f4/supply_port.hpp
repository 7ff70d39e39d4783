#pragma once
// The chip's own supply of 3.3 V.

#include "node_firmware/port/stm32f4/registers.hpp"

namespace kinebus::stm32 {

/// From now on a supply below 2.9 V is an interrupt that nobody handles: power off and reset, while flash and
/// core still work (down to 2.7 V). False: it is that low already. start_clocks() has enabled PWR.
inline bool watch_supply() {
  pwr().CR = pwr().CR | Pwr::kDetect2V9 | Pwr::kDetectorOn;
  if (!wait_until([] { return (pwr().CSR & Pwr::kSupplyLow) == 0; })) return false;
  exti().RTSR = exti().RTSR | Exti::kSupplyDetector;
  exti().IMR = exti().IMR | Exti::kSupplyDetector;
  enable_interrupt(Irq::kSupplyDetector, 0);
  return true;
}

}  // namespace kinebus::stm32
