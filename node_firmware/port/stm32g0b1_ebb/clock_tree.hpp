#pragma once
// Crystal to core: 8 MHz * 16 = 128 MHz, / 2 = 64 MHz for the core, all buses, timers and CAN.

#include "node_firmware/port/stm32g0b1_ebb/registers.hpp"

namespace kinebus::g0b1 {

inline constexpr std::uint32_t kCrystalHz = 8'000'000, kCoreHz = 64'000'000;
/// Local time: TIM2, free-running, 32 bits, 4 MHz.
inline constexpr std::uint32_t kLocalHz = 4'000'000;

/// False: the crystal or the PLL does not start; the core stays on its 16 MHz oscillator.
inline bool start_clocks() {
  constexpr std::uint32_t kM = 1, kN = 16, kR = 2;
  // RM0444: input 2.66 to 16 MHz, VCO 96 to 344 MHz.
  static_assert(kCrystalHz / kM * kN / kR == kCoreHz && kCrystalHz / kM * kN == 128'000'000);
  Rcc& r = rcc();
  r.CR = r.CR | Rcc::kHseOn;
  if (!wait_until([&] { return (r.CR & Rcc::kHseReady) != 0; })) return false;
  r.PLLCFGR = Rcc::kPllFromHse | (kM - 1) << 4 | kN << 8 | (kR - 1) << 29 | Rcc::kPllRToCore;
  // A crystal that stops later is an NMI.
  r.CR = r.CR | Rcc::kPllOn | Rcc::kClockSecurity;
  FlashInterface& f = flash_interface();
  f.ACR = (f.ACR & ~FlashInterface::kWaitStatesMask) | FlashInterface::kWaitStates2 |
          FlashInterface::kPrefetch | FlashInterface::kInstructionCache;
  if (!wait_until([&] { return (f.ACR & FlashInterface::kWaitStatesMask) == FlashInterface::kWaitStates2; }))
    return false;
  if (!wait_until([&] { return (r.CR & Rcc::kPllReady) != 0; })) return false;
  r.CFGR = (r.CFGR & ~Rcc::kSwitchMask) | Rcc::kSwitchPll;
  return wait_until([&] { return (r.CFGR & Rcc::kSwitchStatusMask) == Rcc::kSwitchStatusPll; });
}

inline void start_local_time() {
  enable_clock(rcc().APBENR1, Rcc::kTim2);
  tim2().PSC = kCoreHz / kLocalHz - 1;
  tim2().ARR = 0xFFFF'FFFF;
  tim2().EGR = Timer::kGenerateUpdate;  // the prescaler takes effect
  tim2().CR1 = Timer::kEnable;
}
/// 250 ns a count.
inline std::uint32_t local_counts() {
  return tim2().CNT;
}

/// An interrupt every millisecond, for a program that has no other.
inline void start_tick() {
  sys_tick().LOAD = kCoreHz / 1000 - 1;
  sys_tick().VAL = 0;
  sys_tick().CTRL = SysTick::kEnable | SysTick::kInterrupt | SysTick::kCoreClock;
}

}  // namespace kinebus::g0b1
