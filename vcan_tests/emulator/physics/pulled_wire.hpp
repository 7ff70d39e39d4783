#pragma once
// A wire with a resistor to the supply that several parts pull low: the lower one wins, and a rise takes its
// time.

#include "vcan_tests/emulator/cycle.hpp"

namespace kinebus::emulator {

class PulledWire {
 public:
  /// low: somebody pulls. forced: somebody drives it high. pulled_up: the resistor is there. True: the level
  /// has changed.
  bool look(bool low, bool forced, bool pulled_up, Cycle now) {
    if (low != low_) {
      low_ = low;
      rises_ = low ? kNever : forced ? now : now + kRise;
    }
    const bool up = forced || pulled_up;
    const bool level = !low && (rises_ == kNever ? high_ : now >= rises_ && up);
    if (!low && now >= rises_) rises_ = kNever;
    if (level == high_) return false;
    high_ = level;
    return true;
  }
  bool high() const { return high_; }
  bool low() const { return low_; }
  Cycle next_event() const { return rises_; }

 private:
  static constexpr Cycle kRise = 4 * kCoreHz / 1'000'000;
  bool low_ = false, high_ = true;
  Cycle rises_ = kNever;
};

}  // namespace kinebus::emulator
