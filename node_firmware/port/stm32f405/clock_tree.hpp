#pragma once
// Crystal to core: 8 MHz / 4 * 168 = 336 MHz, / 2 = 168 MHz for the core, / 7 = 48 MHz for USB.

#include "node_firmware/port/stm32f405/board.hpp"
#include "node_firmware/port/stm32f405/registers.hpp"

namespace kinebus::stm32 {

struct PllSetting {
  std::uint32_t m = 4, n = 168, p = 2, q = 7;
};
inline constexpr PllSetting kPll{};
static_assert(board::kCrystalHz / kPll.m == 2'000'000, "the PLL's input should be 2 MHz for least jitter");
static_assert(board::kCrystalHz / kPll.m * kPll.n / kPll.p == board::kCoreHz);
static_assert(board::kCrystalHz / kPll.m * kPll.n / kPll.q == 48'000'000);

/// False: the crystal or the PLL does not start; the core stays on its 16 MHz oscillator.
inline bool start_clocks() {
  Rcc& r = rcc();
  enable_clock(r.APB1ENR, Rcc::kPower);
  pwr().CR = pwr().CR | Pwr::kScale1;
  r.CR = r.CR | Rcc::kHseOn;
  if (!wait_until([&] { return (r.CR & Rcc::kHseReady) != 0; })) return false;
  r.PLLCFGR = kPll.m | kPll.n << 6 | (kPll.p / 2 - 1) << 16 | Rcc::kPllFromHse | kPll.q << 24;
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
