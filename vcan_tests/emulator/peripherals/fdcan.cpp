#include "vcan_tests/emulator/peripherals/fdcan.hpp"

#include <algorithm>
#include <utility>

#include "protocol/bytes.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kFdcanInit = 1, kFdcanChange = 2;
constexpr std::uint32_t kErrorPassive = 1u << 5, kErrorWarning = 1u << 6, kBusOffState = 1u << 7;  // PSR
constexpr std::uint32_t kPassiveChanged = 1u << 17, kWarningChanged = 1u << 18, kOffChanged = 1u << 19;  // IR
constexpr std::uint32_t kExtendedId = 1u << 30, kRemoteFrame = 1u << 29;
constexpr std::uint32_t kFifoAt[2] = {0xB0, 0x188}, kTransmitAt = 0x278, kElement = 72;
constexpr Cycle kBit = kCoreHz / 1'000'000;
constexpr Cycle kJoinTime = 11 * kBit, kRecoveryTime = Cycle{129} * 11 * kBit;
constexpr std::uint32_t kClockHz = 64'000'000;

}  // namespace

void Fdcan::reset() {
  cccr_ = kFdcanInit;
  nbtp_ = 0x06000A03;
  ir_ = ie_ = ils_ = ile_ = rxgfc_ = txbc_ = 0;
  pending_ = occurred_ = cancelled_ = cancelling_ = 0;
  fifos_ = {};
  tec_ = rec_ = last_state_ = 0;
  bus_off_ = joined_ = false;
  joins_ = kNever;
  for (int i = 0; i < kMailboxes; ++i) requests_.push_back({0, i, true, {}});  // whatever waited is gone
  update_lines();
}

void Fdcan::lose_memory() {
  // A filter that fits everything, with the highest priority there is: whoever trusts it is found out.
  memory_.fill(0xBFFF0000);
}

int Fdcan::put_index() const {
  for (int i = 0; i < kMailboxes; ++i)
    if ((pending_ >> i & 1) == 0) return i;
  return -1;
}

CanFrame Fdcan::frame_of(int buffer) const {
  const std::size_t at = (kTransmitAt + kElement * static_cast<std::uint32_t>(buffer)) / 4;
  CanFrame frame;
  frame.extended = (memory_[at] & kExtendedId) != 0;
  frame.remote = (memory_[at] & kRemoteFrame) != 0;
  frame.id = frame.extended ? memory_[at] & 0x1FFFFFFF : memory_[at] >> 18 & 0x7FF;
  const std::uint32_t length = memory_[at + 1] >> 16 & 0xF;
  frame.length = static_cast<std::uint8_t>(length > 8 ? 8 : length);
  std::array<std::uint8_t, 8> data{};
  put_u32_le(data, memory_[at + 2]);
  put_u32_le(std::span(data).subspan(4), memory_[at + 3]);
  for (std::size_t i = 0; i < frame.length && !frame.remote; ++i) frame.data[i] = data[i];
  return frame;
}

std::vector<CanController::Request> Fdcan::take_requests() {
  return std::exchange(requests_, {});
}

void Fdcan::on_sent(int buffer) {
  const std::uint32_t bit = 1u << buffer;
  if ((pending_ & bit) == 0) return;
  pending_ &= ~bit;
  occurred_ |= bit;
  if ((cancelling_ & bit) != 0) cancelled_ |= bit;  // too late: both flags
  cancelling_ &= ~bit;
  ++counters_.sent;
  if (tec_ > 0) --tec_;
  watch_errors();
  update_lines();
}

void Fdcan::on_aborted(int buffer) {
  const std::uint32_t bit = 1u << buffer;
  if ((pending_ & bit) == 0) return;
  pending_ &= ~bit;
  cancelling_ &= ~bit;
  cancelled_ |= bit;
}

std::optional<std::size_t> Fdcan::match(const CanFrame& frame) const {
  if (frame.remote && (rxgfc_ & (frame.extended ? 1 : 2)) != 0) return std::nullopt;
  if (!frame.extended) {
    const std::uint32_t filters = std::min<std::uint32_t>(rxgfc_ >> 16 & 0x1F, 28);
    for (std::uint32_t i = 0; i < filters; ++i) {
      const std::uint32_t filter = memory_[i], kind = filter >> 30, where = filter >> 27 & 7;
      const std::uint32_t first = filter >> 16 & 0x7FF, second = filter & 0x7FF;
      const bool fits = kind == 0   ? frame.id >= first && frame.id <= second
                        : kind == 1 ? frame.id == first || frame.id == second
                        : kind == 2 ? ((frame.id ^ first) & second) == 0
                                    : false;
      if (!fits || where == 0) continue;
      if (where == 1 || where == 5) return 0;
      if (where == 2 || where == 6) return 1;
      return std::nullopt;
    }
  }
  const std::uint32_t rest = rxgfc_ >> (frame.extended ? 2 : 4) & 3;
  return rest < 2 ? std::optional<std::size_t>(rest) : std::nullopt;
}

void Fdcan::store(std::size_t number, const CanFrame& frame) {
  Fifo& fifo = fifos_[number];
  if (fifo.count == 3) {
    fifo.lost = true;
    ir_ |= 4u << (3 * number);
    ++counters_.overruns;
    return;
  }
  const std::size_t at = (kFifoAt[number] + kElement * ((fifo.get + fifo.count) % 3)) / 4;
  memory_[at] = frame.extended ? frame.id | kExtendedId : frame.id << 18;
  if (frame.remote) memory_[at] |= kRemoteFrame;
  memory_[at + 1] = static_cast<std::uint32_t>(frame.length) << 16;
  memory_[at + 2] = get_u32_le(frame.data);
  memory_[at + 3] = get_u32_le(std::span(frame.data).subspan(4));
  ++fifo.count;
  ir_ |= 1u << (3 * number);
  if (fifo.count == 3) ir_ |= 2u << (3 * number);
  ++counters_.accepted;
}

void Fdcan::on_frame(const CanFrame& frame, Cycle now) {
  if ((cccr_ & kFdcanInit) == 0 && !joined_ && !bus_off_)
    joins_ = now;  // the end of a frame has 11 recessive bits
  if (!listening()) return;
  ++counters_.received;
  if (rec_ > 0) rec_ = rec_ > 127 ? 120 : rec_ - 1;
  watch_errors();
  if (const auto fifo = match(frame)) store(*fifo, frame);
  update_lines();
}

void Fdcan::on_error(bool sending, Cycle) {
  if (!listening()) return;
  if (sending)
    tec_ += 8;
  else if (rec_ < 128)
    ++rec_;
  if (tec_ > 255) {
    bus_off_ = true;
    joined_ = false;
    cccr_ |= kFdcanInit;
    ++counters_.bus_offs;
  }
  watch_errors();
  update_lines();
}

void Fdcan::on_no_acknowledge(Cycle) {
  if (!listening()) return;
  if (tec_ <= 127) tec_ += 8;
  watch_errors();
  update_lines();
}

void Fdcan::leave_init(Cycle now) {
  joins_ = now + (bus_off_ ? kRecoveryTime : kJoinTime);
}

void Fdcan::advance(Cycle now) {
  if (joins_ > now) return;
  joins_ = kNever;
  joined_ = true;
  if (bus_off_) tec_ = rec_ = 0;
  bus_off_ = false;
  send_pending(now);
  watch_errors();
  update_lines();
}

void Fdcan::send_pending(Cycle now) {
  if (!listening()) return;
  for (int i = 0; i < kMailboxes; ++i)
    if ((pending_ >> i & 1) != 0) requests_.push_back({now, i, false, frame_of(i)});
}

std::uint32_t Fdcan::state() const {
  std::uint32_t psr = 0;
  if (tec_ >= 96 || rec_ >= 96) psr |= kErrorWarning;
  if (tec_ > 127 || rec_ > 127) psr |= kErrorPassive;
  if (bus_off_) psr |= kBusOffState;
  return psr;
}

// The flags tell of every change, to the worse and to the better.
void Fdcan::watch_errors() {
  const std::uint32_t now = state(), changed = now ^ last_state_;
  if ((changed & kErrorPassive) != 0) ir_ |= kPassiveChanged;
  if ((changed & kErrorWarning) != 0) ir_ |= kWarningChanged;
  if ((changed & kBusOffState) != 0) ir_ |= kOffChanged;
  last_state_ = now;
}

void Fdcan::update_lines() {
  // Groups of ILS: FIFO 0, FIFO 1, status, transmit, other, bit and line error, protocol error.
  constexpr std::uint32_t kGroups[7] = {0x7, 0x38, 0x1C0, 0x1E00, 0xE000, 0x30000, 0xFC0000};
  std::array<bool, 2> on{};
  for (unsigned group = 0; group < 7; ++group)
    if ((ir_ & ie_ & kGroups[group]) != 0) on[ils_ >> group & 1] = true;
  for (unsigned line = 0; line < 2; ++line) lines_.set_line(irqs_[line], on[line] && (ile_ >> line & 1) != 0);
}

std::uint32_t Fdcan::bit_rate() const {
  const std::uint32_t quanta = 1 + ((nbtp_ >> 8 & 0xFF) + 1) + ((nbtp_ & 0x7F) + 1);
  return kClockHz / ((nbtp_ >> 16 & 0x1FF) + 1) / quanta;
}

double Fdcan::sample_point() const {
  const double segment1 = (nbtp_ >> 8 & 0xFF) + 1, segment2 = (nbtp_ & 0x7F) + 1;
  return (1 + segment1) / (1 + segment1 + segment2);
}

std::uint32_t Fdcan::read(std::uint32_t offset, Cycle now) {
  advance(now);
  const auto fifo_status = [](const Fifo& f) {
    return f.count | f.get << 8 | ((f.get + f.count) % 3) << 16 | (f.count == 3 ? 1u << 24 : 0u) |
           (f.lost ? 1u << 25 : 0u);
  };
  switch (offset) {
    case 0x00:
      return 0x32141218;
    case 0x04:
      return 0x87654321;
    case 0x18:
      return cccr_;
    case 0x1C:
      return nbtp_;
    case 0x40:
      return (tec_ > 255 ? 255 : tec_) | (rec_ > 127 ? 127 : rec_) << 8 | (rec_ > 127 ? 1u << 15 : 0);
    case 0x44:
      return state() | (joined_ ? 1u << 3 : 0);
    case 0x50:
      return ir_;
    case 0x54:
      return ie_;
    case 0x58:
      return ils_;
    case 0x5C:
      return ile_;
    case 0x80:
      return rxgfc_;
    case 0x90:
      return fifo_status(fifos_[0]);
    case 0x98:
      return fifo_status(fifos_[1]);
    case 0xC0:
      return txbc_;
    case 0xC4: {
      const int put = put_index();
      return put < 0 ? 1u << 21 : static_cast<std::uint32_t>(put) << 16 | 1;
    }
    case 0xC8:
      return pending_;
    case 0xD4:
      return occurred_;
    case 0xD8:
      return cancelled_;
    default:
      return 0;
  }
}

void Fdcan::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  advance(now);
  switch (offset) {
    case 0x18: {
      const bool was_init = (cccr_ & kFdcanInit) != 0;
      // CCE only with INIT, and it goes with it.
      cccr_ = (value & 0xF3FC) | (value & kFdcanInit) |
              ((value & kFdcanInit) != 0 && was_init ? value & kFdcanChange : 0);
      if (configurable()) {
        pending_ = occurred_ = cancelled_ = cancelling_ = 0;
        fifos_ = {};
        if (joins_ == kNever) joined_ = false;
      }
      if ((cccr_ & kFdcanInit) != 0) {
        joined_ = false;
        joins_ = kNever;
      } else if (was_init) {
        leave_init(now);
      }
      break;
    }
    case 0x1C:
      if (configurable()) nbtp_ = value;
      break;
    case 0x50:
      ir_ &= ~value;
      break;
    case 0x54:
      ie_ = value;
      break;
    case 0x58:
      ils_ = value & 0x7F;
      break;
    case 0x5C:
      ile_ = value & 3;
      break;
    case 0x80:
      if (configurable()) rxgfc_ = value;
      break;
    case 0x94:
    case 0x9C: {
      Fifo& fifo = fifos_[offset == 0x94 ? 0 : 1];
      // What is acknowledged frees all up to it.
      for (std::uint32_t i = 0; fifo.count > 0 && i < 3; ++i) {
        const bool last = fifo.get == (value & 3);
        fifo.get = (fifo.get + 1) % 3;
        --fifo.count;
        if (last) break;
      }
      fifo.lost = false;
      break;
    }
    case 0xC0:
      if (configurable()) txbc_ = value;
      break;
    case 0xCC:
      if ((cccr_ & kFdcanChange) != 0) break;
      for (int i = 0; i < kMailboxes; ++i) {
        if ((value >> i & 1) == 0 || i != put_index()) continue;
        pending_ |= 1u << i;
        occurred_ &= ~(1u << i);
        cancelled_ &= ~(1u << i);
        if (listening()) requests_.push_back({now, i, false, frame_of(i)});
      }
      break;
    case 0xD0:
      for (int i = 0; i < kMailboxes; ++i) {
        const std::uint32_t bit = 1u << i;
        if ((value & pending_ & ~cancelling_ & bit) == 0) continue;
        cancelling_ |= bit;
        requests_.push_back({now, i, true, frame_of(i)});
      }
      break;
    default:
      return;
  }
  update_lines();
}

}  // namespace kinebus::emulator
