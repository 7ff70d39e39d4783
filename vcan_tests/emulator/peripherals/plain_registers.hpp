#pragma once
// Peripherals of which only the registers matter: what is written is read back. RCC, PWR, FLASH's neighbours.

#include <array>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class PlainRegisters : public Peripheral {
 public:
  std::uint32_t read(std::uint32_t offset, Cycle) override { return word(offset); }
  void write(std::uint32_t offset, std::uint32_t value, Cycle) override { word(offset) = value; }

 protected:
  std::uint32_t& word(std::uint32_t offset) { return words_[(offset / 4) % words_.size()]; }

 private:
  std::array<std::uint32_t, 256> words_{};
};

}  // namespace kinebus::emulator
