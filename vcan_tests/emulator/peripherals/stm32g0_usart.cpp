#include "vcan_tests/emulator/peripherals/stm32g0_usart.hpp"

namespace kinebus::emulator::g0 {
namespace {
namespace usart {

constexpr std::uint32_t kCr1 = 0x00, kCr2 = 0x04, kCr3 = 0x08, kBrr = 0x0C, kRqr = 0x18, kIsr = 0x1C,
                        kIcr = 0x20, kRdr = 0x24, kTdr = 0x28;
constexpr std::uint32_t kEnable = 1, kReceiver = 4, kTransmitter = 8, kFifos = 1u << 29;
constexpr std::uint32_t kSwapped = 1u << 15, kHalfDuplex = 8, kDmaForReceived = 0x40;
constexpr std::uint32_t kFramingError = 2, kNoise = 4, kOverrun = 8, kNotEmpty = 0x20, kComplete = 0x40,
                        kNotFull = 0x80, kErrors = 0xF;
constexpr std::uint32_t kShortestBit = 16;  // 16 samples of a bit

}  // namespace usart
}  // namespace

void Usart::reset() {
  cr1_ = cr2_ = cr3_ = brr_ = errors_ = 0;
  to_send_.clear();
  received_.clear();
  bit_at_ = sample_at_ = kNever;
  put_out(false, true, 0);
}

bool Usart::one_wire_at_rx() const {
  return (cr1_ & usart::kEnable) != 0 && (cr3_ & usart::kHalfDuplex) != 0 && (cr2_ & usart::kSwapped) != 0;
}

std::uint32_t Usart::read(std::uint32_t offset, Cycle now) {
  switch (offset) {
    case usart::kCr1:
      return cr1_;
    case usart::kCr2:
      return cr2_;
    case usart::kCr3:
      return cr3_;
    case usart::kBrr:
      return brr_;
    case usart::kIsr:
      return errors_ | (received_.empty() ? 0 : usart::kNotEmpty) |
             (to_send_.empty() && bit_at_ == kNever ? usart::kComplete : 0) |
             (to_send_.size() < room() ? usart::kNotFull : 0);
    case usart::kRdr: {
      if (received_.empty()) {
        ++misused_;
        return 0;
      }
      const std::uint8_t byte = received_.front();
      received_.pop_front();
      static_cast<void>(now);
      return byte;
    }
    default:
      return 0;
  }
}

void Usart::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  const bool enabled = (cr1_ & usart::kEnable) != 0;
  switch (offset) {
    case usart::kCr1: {
      // FIFOs are chosen while it is off.
      const std::uint32_t before = cr1_;
      cr1_ = enabled ? (value & ~usart::kFifos) | (cr1_ & usart::kFifos) : value;
      if (on(usart::kTransmitter) &&
          (before & (usart::kEnable | usart::kTransmitter)) != (usart::kEnable | usart::kTransmitter)) {
        idle_frame_ = true;
        frame_at_ = now;
        bits_left_ = 10;
        bit_ = 0;
        bit_at_ = after(now, 2);
      }
      if (!on(usart::kTransmitter)) {
        bit_at_ = kNever;
        to_send_.clear();
        put_out(false, true, now);
      }
      if (!on(usart::kReceiver)) sample_at_ = kNever;
      break;
    }
    case usart::kCr2:
      if (!enabled) cr2_ = value;
      break;
    case usart::kCr3:
      cr3_ = enabled ? (value & ~usart::kHalfDuplex) | (cr3_ & usart::kHalfDuplex) : value;
      ask(now);
      break;
    case usart::kBrr:
      if (!enabled) brr_ = value & 0xFFFF;
      break;
    case usart::kRqr:
      if ((value & 8) != 0) received_.clear();
      break;
    case usart::kIcr:
      errors_ &= ~(value & usart::kErrors);
      break;
    case usart::kTdr:
      if (!on(usart::kTransmitter) || brr_ < usart::kShortestBit || to_send_.size() >= room()) {
        ++misused_;
        break;
      }
      to_send_.push_back(static_cast<std::uint8_t>(value));
      if (bit_at_ == kNever) bit_at_ = frame_at_ = now, bits_left_ = 0;
      break;
    default:
      break;
  }
}

void Usart::advance(Cycle now) {
  // A bit begins before it is listened to.
  while (next_event() <= now) bit_at_ <= sample_at_ ? next_bit() : sample();
}

void Usart::next_bit() {
  const Cycle at = bit_at_;
  if (bits_left_ > 0 && --bits_left_ > 0) {
    ++bit_;
    bit_at_ = after(frame_at_, 2 * (bit_ + 1));
    if (!idle_frame_) put_out(true, (frame_ >> bit_ & 1) != 0, at);
    return;
  }
  idle_frame_ = false;
  if (to_send_.empty()) {
    bit_at_ = kNever;
    return put_out(false, true, at);
  }
  frame_ = 1u << 9 | std::uint32_t{to_send_.front()} << 1;
  to_send_.pop_front();
  frame_at_ = at;
  bits_left_ = 10;
  bit_ = 0;
  bit_at_ = after(at, 2);
  put_out(true, false, at);
}

void Usart::put_out(bool sends, bool high, Cycle now) {
  if (sends == sends_ && high == out_) return;
  sends_ = sends;
  out_ = high;
  if (on_output) on_output(now);
}

void Usart::on_wire(bool high, Cycle now) {
  if (high == wire_high_) return;
  wire_high_ = high;
  if (high || sample_at_ != kNever || !on(usart::kReceiver) || brr_ < usart::kShortestBit) return;
  edge_at_ = now;
  heard_ = bits_heard_ = 0;
  sample_at_ = after(now, 1);
}

void Usart::sample() {
  const Cycle at = sample_at_;
  if (bits_heard_ == 0 && wire_high_) {  // no start bit
    errors_ |= usart::kNoise;
    sample_at_ = kNever;
    return;
  }
  heard_ |= (wire_high_ ? 1u : 0u) << bits_heard_;
  if (++bits_heard_ < 10) {
    sample_at_ = after(edge_at_, 2 * bits_heard_ + 1);
    return;
  }
  sample_at_ = kNever;
  if (!wire_high_) errors_ |= usart::kFramingError;
  if (received_.size() >= room()) {
    errors_ |= usart::kOverrun;
    return;
  }
  received_.push_back(static_cast<std::uint8_t>(heard_ >> 1));
  ask(at);
}

void Usart::ask(Cycle now) {
  while ((cr3_ & usart::kDmaForReceived) != 0 && !received_.empty() && on_request) {
    const std::size_t before = received_.size();
    on_request(now);
    if (received_.size() == before) return;  // nobody fetches
  }
}

}  // namespace kinebus::emulator::g0
