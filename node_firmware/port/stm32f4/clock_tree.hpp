#pragma once
// Crystal to core: 2 MHz * 168 = 336 MHz, / 2 = 168 MHz for the core, / 7 = 48 MHz for USB.

#include "node_firmware/port/stm32f4/clocks.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

namespace kinebus::stm32 {

/// False: the crystal or the PLL does not start; the core stays on its 16 MHz oscillator.
template <std::uint32_t kCrystalHz>
bool start_clocks() {
  // The PLL's input should be 2 MHz for least jitter. R is the F446's, not used, and has no lesser value; on
  // the F405 it is reserved, with that reset value.
  constexpr std::uint32_t kM = kCrystalHz / 2'000'000, kN = 168, kP = 2, kQ = 7, kR = 2;
  static_assert(kCrystalHz % 2'000'000 == 0 && kM >= 2 && kM <= 63);
  static_assert(kCrystalHz / kM * kN / kP == kCoreHz && kCrystalHz / kM * kN / kQ == 48'000'000);
  Rcc& r = rcc();
  enable_clock(r.APB1ENR, Rcc::kPower);
  pwr().CR = pwr().CR | Pwr::kScale1;
  r.CR = r.CR | Rcc::kHseOn;
  if (!wait_until([&] { return (r.CR & Rcc::kHseReady) != 0; })) return false;
  r.PLLCFGR = kM | kN << 6 | (kP / 2 - 1) << 16 | Rcc::kPllFromHse | kQ << 24 | kR << 28;
  // A crystal that stops later is an NMI, and a break of both timers by hardware.
  r.CR = r.CR | Rcc::kPllOn | Rcc::kClockSecurity;
  flash_interface().ACR = FlashInterface::kWaitStates5 | FlashInterface::kPrefetch |
                          FlashInterface::kInstructionCache | FlashInterface::kDataCache;
  // AHB / 1, APB1 / 4 = 42 MHz, APB2 / 2 = 84 MHz.
  r.CFGR = 5u << 10 | 4u << 13;
  if (!wait_until([&] { return (r.CR & Rcc::kPllReady) != 0; })) return false;
  r.CFGR = r.CFGR | Rcc::kSwitchPll;
  return wait_until([&] { return (r.CFGR & Rcc::kSwitchStatusMask) == Rcc::kSwitchStatusPll; });
}

}  // namespace kinebus::stm32
