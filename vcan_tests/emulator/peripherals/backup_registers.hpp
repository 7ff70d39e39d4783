#pragma once
// The backup registers of the RTC: 20 words that no reset changes while there is power, and that are written
// only where PWR allows it.

#include "vcan_tests/emulator/peripherals/power_control.hpp"

namespace kinebus::emulator {

class BackupRegisters final : public Peripheral {
 public:
  explicit BackupRegisters(PowerControl& power) : power_(power) {}

  void lose_power() { words_ = {}; }
  std::uint32_t read(std::uint32_t offset, Cycle) override { return within(offset) ? at(offset) : 0; }
  void write(std::uint32_t offset, std::uint32_t value, Cycle) override {
    if (within(offset) && power_.backup_writable()) at(offset) = value;
  }

 private:
  static constexpr std::uint32_t kFirst = 0x50, kCount = 20;
  static bool within(std::uint32_t offset) { return offset >= kFirst && offset < kFirst + 4 * kCount; }
  std::uint32_t& at(std::uint32_t offset) { return words_[(offset - kFirst) / 4]; }

  PowerControl& power_;
  std::array<std::uint32_t, kCount> words_{};
};

}  // namespace kinebus::emulator
