#pragma once
// RCC: oscillators and PLL that become ready, the clock tree's arithmetic, reset causes.

#include <array>
#include <optional>

#include "vcan_tests/emulator/peripherals/plain_registers.hpp"

namespace kinebus::emulator {

class Rcc final : public PlainRegisters {
 public:
  enum class ResetCause : std::uint8_t { kPowerOn, kSoftware, kWatchdog, kBrownOut };

  struct Facts {
    std::uint32_t crystal_hz = 8'000'000;
    bool pll_r = false;  ///< the PLL has a third divider, which must be 2 to 7 (F446)
  };
  Rcc() : Rcc(Facts{}) {}
  explicit Rcc(const Facts& facts) : facts_(facts) { reset(ResetCause::kPowerOn); }
  void reset(ResetCause cause);
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;

  /// The crystal stops, or swings again. True: the clock security system was on, and its NMI comes.
  bool set_crystal(bool swings);
  /// It is there, and on.
  bool crystal_swings() { return crystal_ && (word(0x00) & 1u << 16) != 0; }
  std::uint32_t crystal_hz() const { return facts_.crystal_hz; }
  std::uint32_t crystal_divider() { return word(0x08) >> 16 & 0x1F; }  ///< of HSE_RTC
  /// What the registers ask for, with the board's crystal; empty: settings outside the chip's limits.
  std::optional<std::uint32_t> system_hz();
  std::optional<std::uint32_t> apb1_hz();
  std::optional<std::uint32_t> apb2_hz();
  /// The PLL's output for USB, which must be 48 MHz.
  std::optional<std::uint32_t> usb_hz();
  /// A peripheral's bit in AHB1ENR, APB1ENR or APB2ENR.
  struct Clock {
    std::uint32_t enable_register = 0;
    int bit = 0;
  };
  /// The peripheral can be read and written: its clock is on, and since that was written either the register
  /// was read back or kEnableDelay has gone by (ES0182, delay after an RCC peripheral clock enabling).
  bool live(Clock clock, Cycle now);
  bool clock_enabled(std::uint32_t enable_register, int bit) {
    return (word(enable_register) >> bit & 1) != 0;
  }

 private:
  /// The erratum says up to 1 + 4 cycles; a strict chip wants more.
  static constexpr Cycle kEnableDelay = 16;
  struct Fresh {
    std::uint32_t clocks = 0;  // switched on, and not read back since
    Cycle since = 0;
  };
  Fresh& fresh(std::uint32_t enable_register) { return fresh_[enable_register / 4 % fresh_.size()]; }

  Facts facts_;
  std::uint32_t causes_ = 0;
  bool crystal_ = true;
  std::array<Fresh, 8> fresh_{};
};

}  // namespace kinebus::emulator
