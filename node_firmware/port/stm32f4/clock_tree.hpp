#pragma once
// Crystal to core: 2 MHz * 168 = 336 MHz, / 2 = 168 MHz for the core, / 7 = 48 MHz for USB. Which crystal
// there is, is measured first: with another one all would run at another speed, CAN included, and one device
// with a wrong bit rate keeps all others from the bus.

#include <algorithm>
#include <array>

#include "node_firmware/core/reset_report.hpp"
#include "node_firmware/port/stm32f4/clocks.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

namespace kinebus::stm32 {

/// The chip's own oscillator, on which it begins: within 8 % at any temperature (data sheet).
inline constexpr std::uint32_t kInternalHz = 16'000'000;

/// Of the crystal, which must swing, by that oscillator: TIM11 sees every 128th of its periods, through
/// HSE_RTC, which needs neither the RTC nor its clock selected. 0: none comes.
inline std::uint32_t measured_crystal_hz() {
  constexpr std::uint32_t kDivider = 16, kPrescaler = 8, kPeriods = 16, kLooks = 100'000;
  enable_clock(rcc().APB2ENR, Rcc::kTim11);
  rcc().CFGR = (rcc().CFGR & ~Rcc::kCrystalDividerMask) | Rcc::crystal_divider(kDivider);
  Timer& timer = tim11();
  timer.OR = Timer::kInputCrystal;
  timer.CCMR1 = Timer::kCaptureEighth;
  timer.ARR = 0xFFFF;
  timer.CCER = Timer::kCapture1;
  timer.CR1 = Timer::kEnable;
  std::uint32_t first = 0, last = 0;
  bool seen = true;
  for (std::uint32_t i = 0; i <= kPeriods && seen; ++i) {
    seen = wait_until([&] { return (timer.SR & Timer::kCaptured1) != 0; }, kLooks);
    last = timer.CCR[0];
    if (i == 0) first = last;
  }
  timer.CR1 = 0;
  const std::uint32_t counts = (last - first) & 0xFFFF;
  if (!seen || counts == 0) return 0;
  return static_cast<std::uint32_t>(std::uint64_t{kInternalHz} * kDivider * kPrescaler * kPeriods / counts);
}

/// A measurement that may be true: the chip's crystals are of 4 to 26 MHz (data sheet).
constexpr bool may_be_crystal(std::uint32_t hz) {
  return hz > 4'000'000 / 8 * 7 && hz < 26'000'000 / 8 * 9;
}

/// The one that was measured, of those that a board may have; 0: another one.
template <std::size_t kCount>
constexpr std::uint32_t known_crystal(const std::array<std::uint32_t, kCount>& crystals, std::uint32_t hz) {
  for (const std::uint32_t crystal : crystals)
    if (hz > crystal / 8 * 7 && hz < crystal / 8 * 9) return crystal;
  return 0;
}

/// fault_reason::kNone: it runs. kUnmeasuredCrystal: too, as with the first of `kCrystals`, for a meter that
/// fails must not keep a good board from its bus. Otherwise the core stays on its own oscillator: kNoClock,
/// the crystal or the PLL does not start; kOtherCrystal, it is none of the board's.
template <const auto& kCrystals>
std::uint16_t start_clocks() {
  // The PLL's input should be 2 MHz for least jitter. R is the F446's, not used, and has no lesser value; on
  // the F405 it is reserved, with that reset value.
  constexpr std::uint32_t kInputHz = 2'000'000, kN = 168, kP = 2, kQ = 7, kR = 2;
  static_assert(std::ranges::all_of(kCrystals, [](std::uint32_t hz) {
    return hz % kInputHz == 0 && hz / kInputHz >= 2 && hz / kInputHz <= 63;
  }));
  static_assert(kInputHz * kN / kP == kCoreHz && kInputHz * kN / kQ == 48'000'000);
  Rcc& r = rcc();
  enable_clock(r.APB1ENR, Rcc::kPower);
  pwr().CR = pwr().CR | Pwr::kScale1;
  r.CR = r.CR | Rcc::kHseOn;
  if (!wait_until([&] { return (r.CR & Rcc::kHseReady) != 0; })) return fault_reason::kNoClock;
  const std::uint32_t measured_hz = measured_crystal_hz();
  const bool measured = may_be_crystal(measured_hz);
  const std::uint32_t crystal = measured ? known_crystal(kCrystals, measured_hz) : kCrystals[0];
  if (crystal == 0) return fault_reason::kOtherCrystal;
  r.PLLCFGR = crystal / kInputHz | kN << 6 | (kP / 2 - 1) << 16 | Rcc::kPllFromHse | kQ << 24 | kR << 28;
  // A crystal that stops later is an NMI, and a break of both timers by hardware.
  r.CR = r.CR | Rcc::kPllOn | Rcc::kClockSecurity;
  flash_interface().ACR = FlashInterface::kWaitStates5 | FlashInterface::kPrefetch |
                          FlashInterface::kInstructionCache | FlashInterface::kDataCache;
  // AHB / 1, APB1 / 4 = 42 MHz, APB2 / 2 = 84 MHz.
  r.CFGR = 5u << 10 | 4u << 13;
  if (!wait_until([&] { return (r.CR & Rcc::kPllReady) != 0; })) return fault_reason::kNoClock;
  r.CFGR = r.CFGR | Rcc::kSwitchPll;
  const bool switched =
      wait_until([&] { return (r.CFGR & Rcc::kSwitchStatusMask) == Rcc::kSwitchStatusPll; });
  if (!switched) return fault_reason::kNoClock;
  return measured ? fault_reason::kNone : fault_reason::kUnmeasuredCrystal;
}

}  // namespace kinebus::stm32
