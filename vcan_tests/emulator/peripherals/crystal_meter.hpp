#pragma once
// TIM11 as a meter of the crystal: its input 1 is HSE_RTC, the crystal's clock divided as RCC_CFGR says, and
// every so many edges its count is captured. It counts the core's clock, undivided.

#include "vcan_tests/emulator/peripherals/plain_registers.hpp"
#include "vcan_tests/emulator/peripherals/rcc.hpp"

namespace kinebus::emulator {

class CrystalMeter final : public PlainRegisters {
 public:
  /// `hears`: the crystal's edges come to its input.
  CrystalMeter(Rcc& rcc, bool hears) : rcc_(rcc), hears_(hears) {}
  void reset() {
    for (std::uint32_t offset = 0; offset <= kOption; offset += 4) word(offset) = 0;
    seen_ = 0;
  }
  std::uint32_t read(std::uint32_t offset, Cycle now) override {
    if (offset == kStatus) return captures(now) > seen_ ? kCaptured : 0;
    if (offset != kCapture) return word(offset);
    seen_ = captures(now);
    const double seconds = static_cast<double>(seen_) * period_s();
    return static_cast<std::uint32_t>(seconds * rcc_.system_hz().value_or(0)) & word(kReload);
  }
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override {
    const bool began = offset == kControl && (value & 1) != 0 && (word(kControl) & 1) == 0;
    word(offset) = value;
    if (began) began_ = now, seen_ = 0;
  }

 private:
  static constexpr std::uint32_t kControl = 0x00, kStatus = 0x10, kMode = 0x18, kEnable = 0x20,
                                 kReload = 0x2C, kCapture = 0x34, kOption = 0x50, kCaptured = 2;

  double period_s() {
    const std::uint32_t edges = 1u << (word(kMode) >> 2 & 3);
    return static_cast<double>(edges * rcc_.crystal_divider()) / rcc_.crystal_hz();
  }
  std::uint64_t captures(Cycle now) {
    const bool measures = hears_ && (word(kControl) & 1) != 0 && (word(kEnable) & 1) != 0 &&
                          word(kOption) == 2 && (word(kMode) & 3) == 1 && rcc_.crystal_divider() >= 2 &&
                          rcc_.crystal_swings();
    return measures ? static_cast<std::uint64_t>(seconds_of(now - began_) / period_s()) : 0;
  }

  Rcc& rcc_;
  bool hears_;
  Cycle began_ = 0;
  std::uint64_t seen_ = 0;
};

}  // namespace kinebus::emulator
