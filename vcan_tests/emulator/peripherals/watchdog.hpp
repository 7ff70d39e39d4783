#pragma once
// IWDG: counts down at 32 kHz from its start on, whatever the program does; only the reload key holds it off.

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class Watchdog final : public Peripheral {
 public:
  std::uint32_t read(std::uint32_t offset, Cycle) override {
    return offset == 4 ? prescaler_ : offset == 8 ? reload_ : 0;
  }
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override {
    if (offset == 0) {
      unlocked_ = value == 0x5555;
      if (value == 0xCCCC) running_ = true;
      if ((value == 0xAAAA || value == 0xCCCC) && running_) expires_ = now + period();
    } else if (unlocked_) {
      if (offset == 4) prescaler_ = value & 7;
      if (offset == 8) reload_ = value & 0xFFF;
    }
  }
  Cycle next_event() const override { return expires_; }
  bool expired(Cycle now) const { return expires_ <= now; }
  bool running() const { return running_; }
  void reset() {
    running_ = unlocked_ = false;
    prescaler_ = 0;
    reload_ = 0xFFF;
    expires_ = kNever;
  }

 private:
  static constexpr Cycle kCyclesPerClock = kCoreHz / 32'000;
  Cycle period() const { return kCyclesPerClock * (4ULL << prescaler_) * (reload_ + 1ULL); }
  bool running_ = false, unlocked_ = false;
  std::uint32_t prescaler_ = 0, reload_ = 0xFFF;
  Cycle expires_ = kNever;
};

}  // namespace kinebus::emulator
