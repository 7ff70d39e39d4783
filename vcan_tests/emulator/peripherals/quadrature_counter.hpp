#pragma once
// A timer in encoder mode: 16 bits that follow a scale's two channels. It counts only when it is set up as
// the reference manual says, inputs filtered, clock and pins included; what passes while it is not set up is
// lost.

#include <functional>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class QuadratureCounter final : public Peripheral {
 public:
  /// What the scale has counted at that time; asked in the order of time. Empty: nothing is wired to it.
  std::function<std::int32_t(Cycle)> scale;
  /// Both pins lead to this timer.
  std::function<bool()> wired;

  void reset() {
    cr1_ = smcr_ = ccmr1_ = ccer_ = psc_ = 0;
    arr_ = 0xFFFF;
    count_ = 0;
    follows_ = false;
  }
  std::uint32_t read(std::uint32_t offset, Cycle now) override {
    switch (offset) {
      case 0x00:
        return cr1_;
      case 0x08:
        return smcr_;
      case 0x18:
        return ccmr1_;
      case 0x20:
        return ccer_;
      case 0x24:
        follow(now);
        return count_;
      case 0x28:
        return psc_;
      case 0x2C:
        return arr_;
      default:
        return 0;
    }
  }
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override {
    follow(now);
    switch (offset) {
      case 0x00:
        cr1_ = value & 0x3FF;
        break;
      case 0x08:
        smcr_ = value & 0xFFF7;
        break;
      case 0x18:
        ccmr1_ = value & 0xFFFF;
        break;
      case 0x20:
        ccer_ = value & 0xBBBB;
        break;
      case 0x24:
        count_ = value & 0xFFFF;
        break;
      case 0x28:
        psc_ = value & 0xFFFF;
        break;
      case 0x2C:
        arr_ = value & 0xFFFF;
        break;
      default:
        break;
    }
    follow(now);
  }
  bool counts() const {
    const bool encoder = (smcr_ & 7) == 3 && (ccer_ & 0xAA) == 0 && psc_ == 0 && arr_ == 0xFFFF;
    const bool inputs = (ccmr1_ & 0x0303) == 0x0101 && (ccmr1_ >> 4 & 0xF) != 0 && (ccmr1_ >> 12 & 0xF) != 0;
    return (cr1_ & 1) != 0 && encoder && inputs && scale && wired && wired();
  }

 private:
  void follow(Cycle now) {
    if (!counts()) {
      follows_ = false;
      return;
    }
    const std::int32_t there = scale(now);
    if (follows_)
      count_ = (count_ + static_cast<std::uint32_t>(there) - static_cast<std::uint32_t>(last_)) & 0xFFFF;
    last_ = there;
    follows_ = true;
  }

  std::uint32_t cr1_ = 0, smcr_ = 0, ccmr1_ = 0, ccer_ = 0, psc_ = 0, arr_ = 0xFFFF, count_ = 0;
  std::int32_t last_ = 0;
  bool follows_ = false;
};

}  // namespace kinebus::emulator
