#pragma once
// IWDG: counts down from its start on, whatever the program does; only the reload key holds it off. As hard
// to live with as the chips' oscillators allow: it counts at the fastest, 47 kHz, and takes over a new
// prescaler or reload value at the slowest, 17 kHz.

#include <algorithm>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class Watchdog final : public Peripheral {
 public:
  static constexpr Cycle kFastestClock = kCoreHz / 47'000;
  /// Five clocks, for which the busy flag of a register is set, and a further value is not taken.
  static constexpr Cycle kTakesOver = 5 * kCoreHz / 17'000;

  std::uint32_t read(std::uint32_t offset, Cycle now) override {
    switch (offset) {
      case 4:
        return prescaler_.wanted;
      case 8:
        return reload_.wanted;
      case 12:
        return (prescaler_.busy(now) ? 1u : 0u) | (reload_.busy(now) ? 2u : 0u);
      default:
        return 0;
    }
  }
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override {
    if (offset == 0) {
      unlocked_ = value == 0x5555;
      if (value == 0xCCCC && !running_) start(now);
      if ((value == 0xAAAA || value == 0xCCCC) && running_) expires_ = now + period(now);
    } else if (unlocked_) {
      if (offset == 4) prescaler_.write(value & 7, now, running_);
      if (offset == 8) reload_.write(value & 0xFFF, now, running_);
    }
  }
  Cycle next_event() const override { return expires_; }
  bool expired(Cycle now) const { return expires_ <= now; }
  bool running() const { return running_; }
  void reset() {
    running_ = unlocked_ = false;
    prescaler_ = {};
    reload_ = {.in_force = 0xFFF, .wanted = 0xFFF};
    expires_ = kNever;
  }

 private:
  struct Setting {
    std::uint32_t in_force = 0, wanted = 0;
    Cycle taken_at = 0;  ///< kNever: when the oscillator runs, which the start brings
    bool busy(Cycle now) const { return now < taken_at; }
    void write(std::uint32_t value, Cycle now, bool clocked) {
      if (busy(now)) return;
      in_force = wanted;
      wanted = value;
      taken_at = clocked ? now + kTakesOver : kNever;
    }
    std::uint32_t value(Cycle now) const { return busy(now) ? in_force : wanted; }
  };
  void start(Cycle now) {
    running_ = true;
    for (Setting* setting : {&prescaler_, &reload_})
      if (setting->taken_at == kNever) setting->taken_at = now + kTakesOver;
  }
  Cycle period(Cycle now) const {
    return kFastestClock * (Cycle{4} << prescaler_.value(now)) * (reload_.value(now) + Cycle{1});
  }
  bool running_ = false, unlocked_ = false;
  Setting prescaler_, reload_{.in_force = 0xFFF, .wanted = 0xFFF};
  Cycle expires_ = kNever;
};

}  // namespace kinebus::emulator
