#pragma once
// RCC: oscillators and PLL that become ready, the clock tree's arithmetic, reset causes.

#include <optional>

#include "vcan_tests/emulator/peripherals/plain_registers.hpp"

namespace kinebus::emulator {

class Rcc final : public PlainRegisters {
 public:
  enum class ResetCause : std::uint8_t { kPowerOn, kSoftware, kWatchdog };

  Rcc() { reset(ResetCause::kPowerOn); }
  void reset(ResetCause cause);
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;

  /// What the registers ask for, with the board's 8 MHz crystal; empty: settings outside the chip's limits.
  std::optional<std::uint32_t> system_hz();
  std::optional<std::uint32_t> apb1_hz();
  std::optional<std::uint32_t> apb2_hz();
  /// The PLL's output for USB, which must be 48 MHz.
  std::optional<std::uint32_t> usb_hz();
  bool clock_enabled(std::uint32_t enable_register, int bit) {
    return (word(enable_register) >> bit & 1) != 0;
  }

 private:
  std::uint32_t causes_ = 0;
};

}  // namespace kinebus::emulator
