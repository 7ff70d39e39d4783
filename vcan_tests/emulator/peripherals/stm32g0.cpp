#include "vcan_tests/emulator/peripherals/stm32g0.hpp"

#include <algorithm>
#include <utility>

namespace kinebus::emulator::g0 {
namespace {

// RCC
constexpr std::uint32_t kCr = 0x00, kCfgr = 0x08, kPllCfgr = 0x0C, kIopEnr = 0x34, kApbEnr2 = 0x40,
                        kCsr = 0x60;
constexpr std::uint32_t kHsiHz = 16'000'000;
// Flash: DS13560, maximum.
constexpr Cycle kProgramTime = kCoreHz / 1'000'000 * 125, kEraseTime = kCoreHz / 1000 * 40;
constexpr std::uint32_t kLock = 1u << 31, kBusy = 1u << 16;
constexpr std::uint32_t kProgramError = 1u << 3, kAlignmentError = 1u << 5, kSizeError = 1u << 6,
                        kSequenceError = 1u << 7;
// RM0444, bus matrix: behind the processor's single-cycle bus.
constexpr std::uint32_t kIoPorts = 0x50000000, kIoPortsEnd = 0x50001800;

bool of_io_ports(std::uint32_t address) {
  return address >= kIoPorts && address < kIoPortsEnd;
}

}  // namespace

void ResetClock::reset(Rcc::ResetCause cause) {
  for (std::uint32_t offset = 0; offset < 0x80; offset += 4) word(offset) = 0;
  word(kCr) = 0x500;
  word(kPllCfgr) = 0x1000;
  fresh_ = 0;
  constexpr std::uint32_t kPin = 1u << 26;
  switch (cause) {
    case Rcc::ResetCause::kPowerOn:
    case Rcc::ResetCause::kBrownOut:
      causes_ |= 1u << 27 | kPin;
      break;
    case Rcc::ResetCause::kSoftware:
      causes_ |= 1u << 28 | kPin;
      break;
    case Rcc::ResetCause::kWatchdog:
      causes_ |= 1u << 29 | kPin;
      break;
  }
}

std::uint32_t ResetClock::read(std::uint32_t offset, Cycle) {
  std::uint32_t value = word(offset);
  if (offset == fresh_register_) fresh_ = 0;
  if (offset == kCr) value = (value & ~0x02020400u) | (value & 0x01010000u) << 1 | (value & 0x100u) << 2;
  if (offset == kCfgr) value = (value & ~0x38u) | (value & 7) << 3;
  if (offset == kCsr) value = (value & 1) | (value & 1) << 1 | causes_;
  return value;
}

void ResetClock::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  if (offset >= kIopEnr && offset <= kApbEnr2) {
    if (offset != fresh_register_ || now >= since_ + kEnableDelay) fresh_ = 0;
    fresh_ = (fresh_ | ~word(offset)) & value;
    fresh_register_ = offset;
    since_ = now;
  }
  if (offset == kCsr && (value & 1u << 23) != 0) causes_ = 0;
  // The PLL takes no new setting while it runs.
  if (offset == kPllCfgr && (word(kCr) & 1u << 24) != 0) return;
  word(offset) = value;
}

bool ResetClock::live(const Rcc::Clock& clock, Cycle now) {
  if ((word(clock.enable_register) >> clock.bit & 1) == 0) return false;
  const bool fresh = clock.enable_register == fresh_register_ && (fresh_ >> clock.bit & 1) != 0;
  return !fresh || now >= since_ + kEnableDelay;
}

std::uint32_t ResetClock::system_hz() {
  const std::uint32_t source = word(kCfgr) & 7, pll = word(kPllCfgr);
  if ((word(kCfgr) & 0x7F00) != 0) return 0;  // AHB and APB undivided: all that is used here
  if (source == 0) return kHsiHz >> (word(kCr) >> 11 & 7);
  if (source != 2 || (word(kCr) & 1u << 24) == 0 || (pll & 1u << 28) == 0) return 0;
  const std::uint32_t from = pll & 3, m = (pll >> 4 & 7) + 1, n = pll >> 8 & 0x7F, r = (pll >> 29 & 7) + 1;
  if (from < 2 || (from == 3 && (word(kCr) & 1u << 16) == 0)) return 0;
  const std::uint32_t input = (from == 3 ? crystal_hz_ : kHsiHz) / m;
  const std::uint64_t vco = std::uint64_t{input} * n;
  if (input < 2'660'000 || input > 16'000'000 || n < 8 || n > 86 || vco < 96'000'000 || vco > 344'000'000 ||
      r < 2 || vco / r > 64'000'000)
    return 0;
  return static_cast<std::uint32_t>(vco / r);
}

void Exti::reset() {
  rising_ = falling_ = rose_ = fell_ = mask_ = 0;
  source_ = {};
  update();
}

void Exti::on_level(int port, int pin, bool level) {
  const auto line = static_cast<std::size_t>(pin);
  const auto bit = static_cast<std::uint16_t>(1u << port);
  if (((level_[line] & bit) != 0) == level) return;
  level_[line] = static_cast<std::uint16_t>(level_[line] ^ bit);
  if ((source_[line / 4] >> (8 * (line % 4)) & 0xFF) != static_cast<std::uint32_t>(port)) return;
  if (level)
    rose_ |= rising_ & 1u << line;
  else
    fell_ |= falling_ & 1u << line;
  update();
}

void Exti::update() {
  const std::uint32_t active = (rose_ | fell_) & mask_;
  lines_.set_line(5, (active & 0x3) != 0);
  lines_.set_line(6, (active & 0xC) != 0);
  lines_.set_line(7, (active & 0xFFF0) != 0);
}

std::uint32_t Exti::read(std::uint32_t offset, Cycle) {
  if (offset >= 0x60 && offset < 0x70) return source_[(offset - 0x60) / 4];
  switch (offset) {
    case 0x00:
      return rising_;
    case 0x04:
      return falling_;
    case 0x0C:
      return rose_;
    case 0x10:
      return fell_;
    case 0x80:
      return mask_;
    default:
      return 0;
  }
}

void Exti::write(std::uint32_t offset, std::uint32_t value, Cycle) {
  if (offset >= 0x60 && offset < 0x70) source_[(offset - 0x60) / 4] = value;
  if (offset == 0x00) rising_ = value;
  if (offset == 0x04) falling_ = value;
  if (offset == 0x0C) rose_ &= ~value;
  if (offset == 0x10) fell_ &= ~value;
  if (offset == 0x80) mask_ = value;
  update();
}

void Flash::reset() {
  acr_ = 0x600;
  sr_ = 0;
  cr_ = kLock;
  key_step_ = 0;
  low_at_ = 0;
  busy_until_ = 0;
}

bool Flash::take_erased() {
  return std::exchange(erased_, false);
}

bool Flash::fail(std::uint32_t flag) {
  sr_ |= flag;
  low_at_ = 0;
  ++errors_;
  return false;
}

std::uint32_t Flash::read(std::uint32_t offset, Cycle now) {
  switch (offset) {
    case 0x00:
      return acr_;
    case 0x10:
      return sr_ | (now < busy_until_ ? kBusy : 0) | (low_at_ != 0 ? 1u << 18 : 0);
    case 0x14:
      return cr_;
    default:
      return 0;
  }
}

void Flash::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  switch (offset) {
    case 0x00:
      acr_ = value;
      break;
    case 0x08:
      if (key_step_ == 0 && value == 0x45670123) {
        key_step_ = 1;
      } else if (key_step_ == 1 && value == 0xCDEF89AB) {
        cr_ &= ~kLock;
        key_step_ = 0;
      } else {
        key_step_ = 2;  // a wrong key locks until reset
      }
      break;
    case 0x10:
      sr_ &= ~value;
      break;
    case 0x14: {
      if ((cr_ & kLock) != 0) break;
      cr_ = value & ~(1u << 16);
      if ((value & 1u << 16) == 0 || (value & 2) == 0) break;
      // An error that is still set keeps the operation from beginning.
      if ((sr_ & 0xC3FA) != 0) {
        fail(kSequenceError);
        break;
      }
      const std::uint32_t page = value >> 3 & 0x3FF;
      if ((value & 1) != 0 || (std::size_t{page} + 1) * kPage > memory_.size()) {
        fail(kSequenceError);
        break;
      }
      std::ranges::fill(memory_.subspan(std::size_t{page} * kPage, kPage), std::uint8_t{0xFF});
      erased_ = true;
      ++erases_;
      busy_until_ = std::max(busy_until_, now) + kEraseTime;
      break;
    }
    default:
      break;
  }
}

bool Flash::program(std::uint32_t address, std::uint32_t value, int size, Cycle now) {
  if ((cr_ & kLock) != 0 || (cr_ & 1) == 0 || (sr_ & 0xC3FA) != 0) return fail(kSequenceError);
  if (size != 4) return fail(kSizeError);
  const std::uint32_t at = address - kBase;
  if (at + 4 > memory_.size()) return fail(kAlignmentError);
  if (low_at_ == 0) {
    if (at % 8 != 0) return fail(kAlignmentError);
    low_at_ = address;
    low_ = value;
    // Looked at now: behind this store the processor's memory has the lower word already.
    blank_ = std::ranges::all_of(memory_.subspan(at, 8), [](std::uint8_t byte) { return byte == 0xFF; });
    return false;
  }
  if (address != low_at_ + 4) return fail(kAlignmentError);
  low_at_ = 0;
  const auto bytes = memory_.subspan(at - 4, 8);
  if (!blank_ && (low_ != 0 || value != 0)) return fail(kProgramError);
  for (unsigned i = 0; i < 4; ++i) {
    bytes[i] = static_cast<std::uint8_t>(low_ >> (8 * i));
    bytes[4 + i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
  busy_until_ = std::max(busy_until_, now) + kProgramTime;
  return true;
}

void Dma::reset() {
  channels_ = {};
  flags_ = 0;
  update();
}

void Dma::update() {
  const auto asks = [&](std::size_t channel) {
    const std::uint32_t flags = flags_ >> (4 * channel), ccr = channels_[channel].ccr;
    return (flags & ccr & 0xE) != 0;
  };
  lines_.set_line(9, asks(0));
  lines_.set_line(10, asks(1) || asks(2));
}

void Dma::on_request(std::uint32_t line, Cycle at) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& c = channels_[i];
    // Words from memory that goes on to one place, bytes the other way: all that is modelled; anything else
    // is an error.
    constexpr std::uint32_t kKind = 0x4FD0, kWordsOut = 0xA90, kBytesIn = 0x80;
    if ((c.ccr & 1) == 0 || (c.request & 0x7F) != line) continue;
    const std::uint32_t kind = c.ccr & kKind, done = c.cndtr - c.left;
    const std::uint32_t memory = c.cmar + (kind == kBytesIn ? done : 4 * done);
    if (kind == kBytesIn && c.left == 0) continue;
    if ((kind != kWordsOut && kind != kBytesIn) || c.left == 0 || of_io_ports(c.cpar) ||
        of_io_ports(memory)) {
      flags_ |= 9u << (4 * i);
      c.ccr &= ~1u;
      continue;
    }
    if (kind == kBytesIn)
      keep(memory, take(c.cpar, at));
    else
      put(c.cpar, fetch(memory), at);
    --c.left;
    if (c.left == c.cndtr / 2) flags_ |= 5u << (4 * i);
    if (c.left == 0) {
      flags_ |= 3u << (4 * i);
      if ((c.ccr & 0x20) != 0) c.left = c.cndtr;
    }
  }
  update();
}

std::uint32_t Dma::read(std::uint32_t offset, Cycle) {
  if (offset == 0) return flags_;
  if (offset >= 0x800 && offset < 0x81C) return channels_[(offset - 0x800) / 4].request;
  if (offset < 8 || offset >= 8 + 20 * kChannels) return 0;
  const Channel& c = channels_[(offset - 8) / 20];
  const std::array words{c.ccr, c.left, c.cpar, c.cmar, 0u};
  return words[(offset - 8) / 4 % 5];
}

void Dma::write(std::uint32_t offset, std::uint32_t value, Cycle) {
  if (offset == 4) {
    // The global flag of a channel clears all of its flags.
    for (unsigned i = 0; i < 7; ++i)
      flags_ &= ~((value >> (4 * i) & 1) != 0 ? 0xFu << (4 * i) : value & 0xFu << (4 * i));
    return update();
  }
  if (offset >= 0x800 && offset < 0x81C) {
    channels_[(offset - 0x800) / 4].request = value;
    return;
  }
  if (offset < 8 || offset >= 8 + 20 * kChannels) return;
  Channel& c = channels_[(offset - 8) / 20];
  const std::uint32_t what = (offset - 8) / 4 % 5;
  if (what == 0) {
    if ((c.ccr & 1) == 0 && (value & 1) != 0) c.left = c.cndtr;
    c.ccr = value;
  } else if ((c.ccr & 1) == 0) {  // the others are read-only while the channel is on
    if (what == 1) c.cndtr = c.left = value & 0xFFFF;
    if (what == 2) c.cpar = value;
    if (what == 3) c.cmar = value;
  }
  update();
}

}  // namespace kinebus::emulator::g0
