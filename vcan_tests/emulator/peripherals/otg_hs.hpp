#pragma once
// OTG_HS as a full-speed device with no cable in it: the core's registers answer as after power-up, nothing
// ever comes.

#include <map>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class OtgHs final : public Peripheral {
 public:
  std::uint32_t read(std::uint32_t offset, Cycle) override {
    if (offset == kReset) return words_[offset] | kAhbIdle;
    if (offset == kInterruptStatus) return 0x04000020;
    const auto found = words_.find(offset);
    return found == words_.end() ? 0 : found->second;
  }
  void write(std::uint32_t offset, std::uint32_t value, Cycle) override {
    if (offset >= kFifos) return;
    // Resets and flushes are done at once.
    words_[offset] = offset == kReset ? value & ~0x3Fu : value;
  }
  void reset() { words_.clear(); }

 private:
  static constexpr std::uint32_t kReset = 0x10, kInterruptStatus = 0x14, kAhbIdle = 1u << 31, kFifos = 0x1000;
  std::map<std::uint32_t, std::uint32_t> words_;
};

}  // namespace kinebus::emulator
