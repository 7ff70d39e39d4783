#pragma once
// PWR: the detector that compares the chip's own supply with a level (PVD), and the lock of the backup
// registers.

#include <array>

#include "vcan_tests/emulator/peripherals/plain_registers.hpp"

namespace kinebus::emulator {

class PowerControl final : public PlainRegisters {
 public:
  static constexpr int kDetectorLine = 16;  ///< of EXTI

  void reset() { word(kCr) = 0x4000; }
  std::uint32_t read(std::uint32_t offset, Cycle) override {
    return offset == kCsr ? (supply_low() ? 4u : 0u) | 0x4000 : word(offset);
  }
  bool backup_writable() { return (word(kCr) & 0x100) != 0; }
  void set_supply(double volts) { volts_ = volts; }
  bool supply_low() {
    constexpr std::array<double, 8> kLevels{2.0, 2.1, 2.3, 2.5, 2.6, 2.7, 2.8, 2.9};
    return (word(kCr) & 0x10) != 0 && volts_ < kLevels[word(kCr) >> 5 & 7];
  }

 private:
  static constexpr std::uint32_t kCr = 0, kCsr = 4;
  double volts_ = 3.3;
};

}  // namespace kinebus::emulator
