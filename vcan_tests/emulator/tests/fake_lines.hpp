#pragma once
// Interrupt lines without a processor: their levels.

#include <array>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class Lines final : public InterruptLines {
 public:
  void set_line(int irq, bool level) override { level_[static_cast<std::size_t>(irq)] = level; }
  bool operator[](int irq) const { return level_[static_cast<std::size_t>(irq)]; }

 private:
  std::array<bool, 96> level_{};
};

}  // namespace kinebus::emulator
