#include "vcan_tests/emulator/peripherals/otg_hs.hpp"

#include <algorithm>

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kGotgctl = 0x00, kGahbcfg = 0x08, kGusbcfg = 0x0C, kGrstctl = 0x10, kGintsts = 0x14,
                        kGintmsk = 0x18, kGrxstsr = 0x1C, kGrxstsp = 0x20, kGrxfsiz = 0x24, kDieptxf0 = 0x28,
                        kGccfg = 0x38, kDieptxf1 = 0x104;
constexpr std::uint32_t kDcfg = 0x800, kDctl = 0x804, kDsts = 0x808, kDiepmsk = 0x810, kDoepmsk = 0x814,
                        kIn = 0x900, kOut = 0xB00, kBehindEndpoints = 0xD00, kFifos = 0x1000;
constexpr std::uint32_t kReceiveLevel = 1u << 4, kStartOfFrame = 1u << 3, kSuspend = 1u << 11,
                        kReset = 1u << 12, kEnumerated = 1u << 13, kInEndpoint = 1u << 18,
                        kOutEndpoint = 1u << 19;
constexpr std::uint32_t kActive = 1u << 15, kNakStatus = 1u << 17, kStall = 1u << 21, kClearNak = 1u << 26,
                        kSetNak = 1u << 27, kDataZero = 1u << 28, kDisable = 1u << 30,
                        kEndpointEnable = 1u << 31;
constexpr std::uint32_t kComplete = 1u << 0, kDisabled = 1u << 1, kSetupPhase = 1u << 3,
                        kNakInForce = 1u << 6;
constexpr std::uint32_t kOutData = 2, kOutDone = 3, kSetupDone = 4, kSetupData = 6;
constexpr Cycle kForcedModeTakes = kCoreHz / 1000 * 25;

std::uint32_t packets(std::uint32_t tsiz) {
  return tsiz >> 19 & 0x3FF;
}
std::size_t words(std::size_t bytes) {
  return (bytes + 3) / 4;
}

}  // namespace

void OtgHs::reset() {
  plain_.fill(0);
  in_ = {};
  out_ = {};
  in_[0].ctl = out_[0].ctl = kActive;
  receive_.clear();
  reading_.clear();
  flags_ = address_ = 0;
  writing_ = -1;
  forced_at_ = kNever;
  if (facts_.later_core) plain_[kDctl / 4] = 2;
  update_line();
}

void OtgHs::violation(const std::string& what) {
  if (violations_.size() < 20) violations_.push_back(what);
}

std::uint32_t OtgHs::status() const {
  std::uint32_t value = flags_ | 1u << 5;
  if (!receive_.empty()) value |= kReceiveLevel;
  for (const Endpoint& e : in_)
    if ((e.interrupt & plain_[kDiepmsk / 4]) != 0) value |= kInEndpoint;
  for (const Endpoint& e : out_)
    if ((e.interrupt & plain_[kDoepmsk / 4]) != 0) value |= kOutEndpoint;
  return value;
}

void OtgHs::update_line() {
  lines_.set_line(facts_.irq, (plain_[kGahbcfg / 4] & 1) != 0 && (status() & plain_[kGintmsk / 4]) != 0);
}

std::uint32_t OtgHs::read(std::uint32_t offset, Cycle) {
  if (offset >= kFifos) return pop_word();
  if (offset >= kIn && offset < kBehindEndpoints) return endpoint_read(offset);
  switch (offset) {
    case kGrstctl:
      return 1u << 31;  // the bus is idle, resets and flushes are done at once
    case kGintsts:
      return status();
    case kGrxstsr:
      return receive_.empty() ? 0 : receive_.front().status;
    case kGrxstsp:
      return pop_status();
    case kDsts:
      return 3u << 1;  // full speed
    default:
      return plain_[offset / 4];
  }
}

void OtgHs::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  if (offset >= kFifos) {
    write_fifo(static_cast<int>(offset / kFifos) - 1, value);
  } else if (offset >= kIn && offset < kBehindEndpoints) {
    endpoint_write(offset, value);
  } else {
    switch (offset) {
      case kGrstctl:
        write_reset(value);
        break;
      case kGintsts:
        flags_ &= ~value;
        break;
      case kGusbcfg:
        forced_at_ = (value & 1u << 30) == 0 ? kNever : std::min(forced_at_, now);
        plain_[offset / 4] = value;
        break;
      default:
        plain_[offset / 4] = value;
        if (offset == kDcfg && programmed_address() == 0) address_ = 0;
        break;
    }
  }
  update_line();
}

void OtgHs::write_reset(std::uint32_t value) {
  if ((value & 1) != 0) {
    const std::uint32_t configuration = plain_[kGusbcfg / 4];
    reset();
    plain_[kGusbcfg / 4] = configuration & 1u << 6;
  }
  if ((value & 1u << 4) != 0) {
    receive_.clear();
    reading_.clear();
  }
  if ((value & 1u << 5) != 0) {
    const std::uint32_t which = value >> 6 & 0x1F;
    for (std::size_t n = 0; n < in_.size(); ++n) {
      if (which != n && which != 16) continue;
      if ((in_[n].ctl & kEndpointEnable) != 0 && !in_[n].nak)
        violation("FIFO flushed while its endpoint may send");
      in_[n].fifo.clear();
      in_[n].written = 0;
      if (writing_ == static_cast<int>(n)) writing_ = -1;
    }
  }
}

std::uint32_t OtgHs::pop_status() {
  if (receive_.empty()) {
    violation("GRXSTSP read with nothing received");
    return 0;
  }
  if (!reading_.empty()) violation("GRXSTSP read with words of the last packet left");
  const Entry entry = receive_.front();
  receive_.pop_front();
  reading_ = entry.words;
  Endpoint& e = out_[entry.status & 0xF];
  const std::uint32_t what = entry.status >> 17 & 0xF;
  if (what == kOutDone || what == kSetupDone) {
    e.ctl &= ~kEndpointEnable;
    e.interrupt |= what == kOutDone ? kComplete : kSetupPhase;
  }
  update_line();
  return entry.status;
}

std::uint32_t OtgHs::pop_word() {
  if (reading_.empty()) {
    violation("FIFO read with nothing in it");
    return 0;
  }
  const std::uint32_t word = reading_.front();
  reading_.pop_front();
  return word;
}

std::uint32_t OtgHs::send_words(int number) const {
  return plain_[(number == 0 ? kDieptxf0 : kDieptxf1 + 4 * static_cast<std::uint32_t>(number - 1)) / 4] >> 16;
}

void OtgHs::write_fifo(int number, std::uint32_t value) {
  if (number < 0 || number >= kEndpoints) return violation("no such FIFO");
  Endpoint& e = in_[static_cast<std::size_t>(number)];
  const std::uint32_t bytes = e.tsiz & 0x7FFFF;
  if ((e.ctl & kEndpointEnable) == 0) return violation("FIFO written while its endpoint is not enabled");
  if (e.written >= words(bytes)) return violation("FIFO written beyond the transfer's size");
  if (e.fifo.size() >= send_words(number)) return violation("FIFO overflows");
  e.fifo.push_back(value);
  writing_ = ++e.written < words(bytes) ? number : -1;
}

std::uint32_t OtgHs::endpoint_read(std::uint32_t offset) {
  // Erratum of the chip: the next word for the FIFO would be spoilt.
  if (writing_ >= 0) violation("endpoint register read while a packet is being written");
  const bool is_in = offset < kOut;
  const std::uint32_t number = (offset - (is_in ? kIn : kOut)) / 0x20;
  if (number >= kEndpoints) return 0;
  const Endpoint& e = is_in ? in_[number] : out_[number];
  switch (offset & 0x1F) {
    case 0x00:
      return e.ctl | (e.nak ? kNakStatus : 0);
    case 0x08:
      return e.interrupt;
    case 0x10:
      return e.tsiz;
    case 0x18:
      return is_in ? send_words(static_cast<int>(number)) - static_cast<std::uint32_t>(e.fifo.size()) : 0;
    default:
      return 0;
  }
}

void OtgHs::endpoint_write(std::uint32_t offset, std::uint32_t value) {
  if (writing_ >= 0) violation("endpoint register written while a packet is being written");
  const bool is_in = offset < kOut;
  const std::uint32_t number = (offset - (is_in ? kIn : kOut)) / 0x20;
  if (number >= kEndpoints) return violation("no such endpoint");
  Endpoint& e = is_in ? in_[number] : out_[number];
  switch (offset & 0x1F) {
    case 0x00:
      write_control(e, is_in, static_cast<int>(number), value);
      break;
    case 0x08:
      e.interrupt &= ~value;
      break;
    case 0x10:
      if (is_in && (e.ctl & kEndpointEnable) != 0)
        violation("size of a transfer changed while it is under way");
      e.tsiz = value;
      e.written = 0;
      break;
    default:
      break;
  }
}

void OtgHs::write_control(Endpoint& e, bool is_in, int number, std::uint32_t value) {
  constexpr std::uint32_t kOrders = kClearNak | kSetNak | kDataZero | 1u << 29 | kDisable | kEndpointEnable;
  const bool was_enabled = (e.ctl & kEndpointEnable) != 0;
  const bool stalled = number == 0 && (e.ctl & kStall) != 0;  // taken back by the core only
  e.ctl = (value & ~kOrders & ~kNakStatus) | (was_enabled ? kEndpointEnable : 0) | (stalled ? kStall : 0) |
          (number == 0 ? kActive : 0);
  if ((value & kDataZero) != 0 && number != 0) e.toggle = 0;
  if ((value & kSetNak) != 0) {
    e.nak = true;
    if (is_in) e.interrupt |= kNakInForce;
  }
  if ((value & kClearNak) != 0) {
    e.nak = false;
    e.interrupt &= ~kNakInForce;
  }
  if ((value & kDisable) != 0 && was_enabled) {
    if (!e.nak) violation("endpoint disabled without NAK");
    e.ctl &= ~kEndpointEnable;
    e.interrupt |= kDisabled;
    return;
  }
  if ((value & kEndpointEnable) == 0 || was_enabled) return;
  if ((e.ctl & kActive) == 0) violation("endpoint enabled that is not active");
  if (packets(e.tsiz) == 0) violation("endpoint enabled for no packet");
  if (is_in && static_cast<int>(value >> 22 & 0xF) != number) violation("endpoint with another's FIFO");
  e.ctl |= kEndpointEnable;
}

bool OtgHs::pulled_up(Cycle now) const {
  const std::uint32_t usb = plain_[kGusbcfg / 4], pads = plain_[kGccfg / 4];
  const bool device = forced_at_ != kNever && now >= forced_at_ + kForcedModeTakes;
  // The later core's bit 21 of GCCFG switches sensing on.
  const bool vbus = facts_.later_core ? (pads & 1u << 21) == 0 && (plain_[kGotgctl / 4] & 0xC0) == 0xC0
                                      : (pads & 1u << 21) != 0;
  return device && (usb & 1u << 6) != 0 && (usb >> 10 & 0xF) == 6 && (pads & 1u << 16) != 0 && vbus &&
         (plain_[kDcfg / 4] & 3) == 3 && (plain_[kDctl / 4] & 2) == 0;
}

void OtgHs::bus_reset() {
  std::uint32_t end = plain_[kGrxfsiz / 4];
  for (int n = 0; n < kEndpoints; ++n) {
    const std::uint32_t place =
        plain_[(n == 0 ? kDieptxf0 : kDieptxf1 + 4 * static_cast<std::uint32_t>(n - 1)) / 4];
    if (place == 0) continue;
    if ((place & 0xFFFF) < end) violation("FIFOs overlap");
    end = (place & 0xFFFF) + (place >> 16);
  }
  if (end > facts_.memory_words) violation("FIFOs larger than the memory");
  for (std::size_t n = 1; n < in_.size(); ++n) {
    in_[n].ctl &= ~kActive;
    out_[n].ctl &= ~kActive;
  }
  flags_ = (flags_ & ~kSuspend) | kReset | kEnumerated;
  update_line();
}

void OtgHs::start_of_frame() {
  flags_ |= kStartOfFrame;
  update_line();
}

void OtgHs::suspend() {
  flags_ |= kSuspend;
  update_line();
}

std::uint32_t OtgHs::programmed_address() const {
  return plain_[kDcfg / 4] >> 4 & 0x7F;
}

bool OtgHs::room_for(std::size_t bytes) const {
  std::size_t used = reading_.size();
  for (const Entry& entry : receive_) used += 1 + entry.words.size();
  return used + 2 + words(bytes) <= plain_[kGrxfsiz / 4];
}

void OtgHs::push(int endpoint, std::uint32_t what, const Bytes& bytes, int toggle) {
  Entry entry{.status = static_cast<std::uint32_t>(endpoint) | static_cast<std::uint32_t>(bytes.size()) << 4 |
                        (toggle == 0 ? 0u : 2u) << 15 | what << 17,
              .words = {}};
  for (std::size_t at = 0; at < bytes.size(); at += 4) {
    std::uint32_t word = 0;
    for (std::size_t i = at; i < std::min(at + 4, bytes.size()); ++i)
      word |= static_cast<std::uint32_t>(bytes[i]) << (8 * (i - at));
    entry.words.push_back(word);
  }
  receive_.push_back(std::move(entry));
  update_line();
}

OtgHs::Answer OtgHs::setup(int address, const std::array<std::uint8_t, 8>& bytes) {
  if (!addressed(address) || !room_for(bytes.size())) return Answer::kNothing;
  in_[0].ctl &= ~kStall;
  out_[0].ctl &= ~kStall;
  in_[0].nak = out_[0].nak = true;
  in_[0].toggle = out_[0].toggle = 1;
  push(0, kSetupData, Bytes(bytes.begin(), bytes.end()), 0);
  push(0, kSetupDone, {}, 0);
  return Answer::kAck;
}

OtgHs::Answer OtgHs::out(int address, int endpoint, const Bytes& bytes, int toggle) {
  Endpoint& e = out_[static_cast<std::size_t>(endpoint)];
  if (!addressed(address) || (e.ctl & kActive) == 0) return Answer::kNothing;
  if ((e.ctl & kStall) != 0) return Answer::kStall;
  if (e.nak || (e.ctl & kEndpointEnable) == 0 || !room_for(bytes.size())) return Answer::kNak;
  if (toggle != e.toggle) return Answer::kAck;  // had it already
  if (bytes.size() > (e.tsiz & 0x7FFFF)) violation("more came than the transfer has room for");
  e.toggle ^= 1;
  push(endpoint, kOutData, bytes, toggle);
  push(endpoint, kOutDone, {}, toggle);
  e.nak = true;
  return Answer::kAck;
}

OtgHs::Received OtgHs::in(int address, int endpoint) {
  Endpoint& e = in_[static_cast<std::size_t>(endpoint)];
  if (!addressed(address) || (e.ctl & kActive) == 0) return {};
  if ((e.ctl & kStall) != 0) return {.answer = Answer::kStall, .bytes = {}};
  const std::uint32_t bytes = e.tsiz & 0x7FFFF;
  if (e.nak || (e.ctl & kEndpointEnable) == 0 || e.fifo.size() < words(bytes))
    return {.answer = Answer::kNak, .bytes = {}};
  Received got{.answer = Answer::kAck, .bytes = {}, .toggle = e.toggle};
  for (std::uint32_t i = 0; i < bytes; ++i) {
    got.bytes.push_back(static_cast<std::uint8_t>(e.fifo.front() >> (8 * (i % 4))));
    if (i % 4 == 3 || i + 1 == bytes) e.fifo.pop_front();
  }
  e.toggle ^= 1;
  e.tsiz = 0;
  e.ctl &= ~kEndpointEnable;
  e.interrupt |= kComplete;
  if (endpoint == 0) address_ = programmed_address();
  update_line();
  return got;
}

}  // namespace kinebus::emulator
