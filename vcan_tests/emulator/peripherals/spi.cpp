#include "vcan_tests/emulator/peripherals/spi.hpp"

namespace kinebus::emulator {
namespace {
constexpr std::uint32_t kMaster = 4, kSpiEnable = 0x40;
}

void Spi::reset() {
  cr1_ = 0;
  cr2_ = fifo_ ? 0x700 : 0;
  full_ = overrun_ = false;
  waiting_.reset();
  done_ = kNever;
  update_line();
}

void Spi::begin(std::uint16_t value, Cycle now) {
  shifting_ = value;
  done_ = now + bit_time() * static_cast<Cycle>(frame_bits());
}

void Spi::advance(Cycle now) {
  while (done_ <= now) {
    const Cycle at = done_;
    const std::uint16_t answer = device_.exchange(shifting_, at);
    if (full_)
      overrun_ = true;
    else
      received_ = answer;
    full_ = true;
    done_ = kNever;
    if (waiting_) {
      begin(*waiting_, at);
      waiting_.reset();
    }
    update_line();
  }
}

void Spi::update_line() {
  lines_.set_line(irq_, (tells() && (cr2_ & 0x40) != 0) || (!waiting_ && (cr2_ & 0x80) != 0));
}

std::uint32_t Spi::read(std::uint32_t offset, Cycle now) {
  advance(now);
  switch (offset) {
    case 0x00:
      return cr1_;
    case 0x04:
      return cr2_;
    case 0x08:
      return (tells() ? 1u : 0) | (waiting_ ? 0 : 2u) | (overrun_ ? 0x40u : 0) |
             (done_ != kNever ? 0x80u : 0);
    case 0x0C:
      full_ = overrun_ = false;
      update_line();
      return received_;
    default:
      return 0;
  }
}

void Spi::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  advance(now);
  if (offset == 0x00) cr1_ = value;
  if (offset == 0x04) cr2_ = value;
  if (offset == 0x0C && (cr1_ & (kMaster | kSpiEnable)) == (kMaster | kSpiEnable)) {
    if (done_ == kNever)
      begin(static_cast<std::uint16_t>(value), now);
    else
      waiting_ = static_cast<std::uint16_t>(value);
  }
  update_line();
}

}  // namespace kinebus::emulator
