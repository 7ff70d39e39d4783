#pragma once
// USART: bytes out at the set rate, bytes in.

#include <deque>
#include <string>
#include <utility>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class Usart final : public Peripheral {
 public:
  Usart(InterruptLines& lines, int irq, Cycle bus_divider)
      : lines_(lines), irq_(irq), bus_divider_(bus_divider) {}

  std::uint32_t read(std::uint32_t offset, Cycle now) override {
    advance(now);
    switch (offset) {
      case 0x00:
        return (received_.empty() ? 0 : 0x20u) | (waiting_ ? 0 : 0x80u) | (done_ == kNever ? 0x40u : 0);
      case 0x04: {
        if (received_.empty()) return 0;
        const std::uint8_t byte = received_.front();
        received_.pop_front();
        update_line();
        return byte;
      }
      case 0x08:
        return brr_;
      case 0x0C:
        return cr1_;
      case 0x10:
        return cr2_;
      case 0x14:
        return cr3_;
      default:
        return 0;
    }
  }
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override {
    advance(now);
    switch (offset) {
      case 0x04:
        if ((cr1_ & 0x2008) != 0x2008) break;
        if (done_ == kNever) {
          shifting_ = static_cast<char>(value);
          done_ = now + byte_time();
        } else {
          waiting_ = true;
          next_ = static_cast<char>(value);
        }
        break;
      case 0x08:
        brr_ = value;
        break;
      case 0x0C:
        cr1_ = value;
        break;
      case 0x10:
        cr2_ = value;
        break;
      case 0x14:
        cr3_ = value;
        break;
      default:
        break;
    }
    update_line();
  }
  Cycle next_event() const override { return done_; }
  void advance(Cycle now) override {
    while (done_ <= now) {
      sent_ += shifting_;
      if (waiting_) {
        waiting_ = false;
        shifting_ = next_;
        done_ += byte_time();
      } else {
        done_ = kNever;
      }
      update_line();
    }
  }
  void reset() {
    cr1_ = cr2_ = cr3_ = 0;
    waiting_ = false;
    done_ = kNever;
    received_.clear();
    update_line();
  }

  void receive(const std::string& bytes) {
    for (const char byte : bytes) received_.push_back(static_cast<std::uint8_t>(byte));
    update_line();
  }
  std::string take_sent() { return std::exchange(sent_, {}); }
  double baud() const {
    return brr_ == 0 ? 0 : static_cast<double>(kCoreHz) / static_cast<double>(bus_divider_ * brr_);
  }

 private:
  Cycle byte_time() const { return 10 * bus_divider_ * brr_; }
  void update_line() {
    lines_.set_line(irq_, (cr1_ & 0x2000) != 0 &&
                              ((!received_.empty() && (cr1_ & 0x20) != 0) ||
                               (!waiting_ && (cr1_ & 0x80) != 0) || (done_ == kNever && (cr1_ & 0x40) != 0)));
  }

  InterruptLines& lines_;
  int irq_;
  Cycle bus_divider_;
  std::uint32_t brr_ = 0, cr1_ = 0, cr2_ = 0, cr3_ = 0;
  std::deque<std::uint8_t> received_;
  std::string sent_;
  char shifting_ = 0, next_ = 0;
  bool waiting_ = false;
  Cycle done_ = kNever;
};

}  // namespace kinebus::emulator
