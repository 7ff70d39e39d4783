#include "vcan_tests/emulator/peripherals/bxcan.hpp"

#include <utility>

#include "protocol/bytes.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kInitRequest = 1, kSleepRequest = 2, kLocked = 8, kAutoBusOff = 0x40,
                        kSoftwareReset = 0x8000;
constexpr std::uint32_t kErrorInterrupt = 4;  // MSR
constexpr std::uint32_t kRelease = 0x20, kOverrun = 0x10, kFull = 8;
constexpr std::uint32_t kTransmitRequest = 1, kRemote = CanFilterBanks::kRemote,
                        kExtended = CanFilterBanks::kExtended;
constexpr std::uint32_t kWarning = 1, kPassive = 2, kOff = 4;
constexpr Cycle kRecovery =
    Cycle{128} * 11 * (kCoreHz / 1'000'000);  // 128 times 11 recessive bits at 1 Mbit/s
constexpr Cycle kJoin = 11 * (kCoreHz / 1'000'000);

}  // namespace

void BxCan::reset() {
  mcr_ = 0x10002;
  msr_flags_ = ier_ = done_flags_ = 0;
  btr_ = 0x01230000;
  mailboxes_ = {};
  fifos_ = {};
  filters_ = {};
  tec_ = rec_ = last_state_ = lec_ = 0;
  bus_off_ = false;
  recovers_ = joins_ = kNever;
  joined_ = false;
  for (int i = 0; i < kMailboxes; ++i) requests_.push_back({0, i, true, {}});  // whatever waited is gone
  update_lines();
}

CanFrame BxCan::frame_of(const Mailbox& mailbox) {
  CanFrame frame;
  frame.extended = (mailbox.tir & kExtended) != 0;
  frame.remote = (mailbox.tir & kRemote) != 0;
  frame.id = frame.extended ? mailbox.tir >> 3 : mailbox.tir >> 21;
  const std::uint32_t length = mailbox.tdtr & 0xF;
  frame.length = static_cast<std::uint8_t>(length > 8 ? 8 : length);
  if (!frame.remote) {
    std::array<std::uint8_t, 8> data{};
    put_u32_le(data, mailbox.low);
    put_u32_le(std::span(data).subspan(4), mailbox.high);
    for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = data[i];
  }
  return frame;
}

std::vector<BxCan::Request> BxCan::take_requests() {
  return std::exchange(requests_, {});
}

void BxCan::on_sent(int mailbox) {
  Mailbox& m = mailboxes_[static_cast<std::size_t>(mailbox)];
  if (!m.pending) return;
  m.pending = m.abort_asked = false;
  m.tir &= ~kTransmitRequest;
  done_flags_ |= 3u << (8 * mailbox);
  ++counters_.sent;
  if (tec_ > 0) --tec_;
  watch_errors();
  update_lines();
}

void BxCan::on_aborted(int mailbox) {
  Mailbox& m = mailboxes_[static_cast<std::size_t>(mailbox)];
  if (!m.pending) return;
  m.pending = m.abort_asked = false;
  m.tir &= ~kTransmitRequest;
  done_flags_ = (done_flags_ & ~(2u << (8 * mailbox))) | 1u << (8 * mailbox);
  update_lines();
}

void BxCan::store(Fifo& fifo, const CanFrame& frame, int index) {
  Stored stored{CanFilterBanks::identifier(frame), frame.length | static_cast<std::uint32_t>(index) << 8,
                get_u32_le(frame.data), get_u32_le(std::span(frame.data).subspan(4))};
  if (fifo.count == 3) {
    fifo.overrun = true;
    ++counters_.overruns;
    if ((mcr_ & kLocked) == 0) fifo.stored[2] = stored;
    return;
  }
  fifo.stored[static_cast<std::size_t>(fifo.count++)] = stored;
  if (fifo.count == 3) fifo.full_flag = true;
  ++counters_.accepted;
}

void BxCan::set_dominant(bool dominant, Cycle now) {
  dominant_ = dominant;
  if ((mcr_ & 3) == 0 && !joined_) joins_ = dominant ? kNever : now + kJoin;
}

void BxCan::on_frame(const CanFrame& frame, Cycle now) {
  // Its dominant bits begin the count of recessive ones anew; the end of a frame has eleven.
  if ((mcr_ & 3) == 0 && !joined_ && !dominant_) joins_ = now;
  if (!listening()) return;
  ++counters_.received;
  if (rec_ > 0) rec_ = rec_ > 127 ? 120 : rec_ - 1;
  watch_errors();
  if (const auto found = filters_.match(frame))
    store(fifos_[static_cast<std::size_t>(found->fifo)], frame, found->index);
  update_lines();
}

void BxCan::on_error(bool sending, Cycle now) {
  if (!listening()) return;
  lec_ = 4;
  if (sending)
    tec_ += 8;
  else if (rec_ < 128)
    ++rec_;
  if (tec_ > 255) enter_bus_off(now);
  watch_errors();
  update_lines();
}

void BxCan::on_no_acknowledge(Cycle) {
  if (!listening()) return;
  lec_ = 3;
  if (tec_ <= 127) tec_ += 8;
  watch_errors();
  update_lines();
}

void BxCan::enter_bus_off(Cycle now) {
  bus_off_ = true;
  ++counters_.bus_offs;
  recovers_ = (mcr_ & kAutoBusOff) != 0 ? now + kRecovery : kNever;
}

void BxCan::advance(Cycle now) {
  if (joins_ <= now) {
    joins_ = kNever;
    joined_ = true;
    send_pending(now);
  }
  if (recovers_ > now) return;
  recovers_ = kNever;
  bus_off_ = false;
  tec_ = rec_ = 0;
  send_pending(now);
  watch_errors();
  update_lines();
}

// What still waits in the mailboxes is sent now.
void BxCan::send_pending(Cycle now) {
  if (!listening()) return;
  for (int i = 0; i < kMailboxes; ++i)
    if (mailboxes_[static_cast<std::size_t>(i)].pending)
      requests_.push_back({now, i, false, frame_of(mailboxes_[static_cast<std::size_t>(i)])});
}

std::uint32_t BxCan::esr() const {
  std::uint32_t state = 0;
  if (tec_ >= 96 || rec_ >= 96) state |= kWarning;
  if (tec_ > 127 || rec_ > 127) state |= kPassive;
  if (bus_off_) state |= kOff;
  return state | lec_ << 4 | (tec_ > 255 ? 255 : tec_) << 16 | rec_ << 24;
}

void BxCan::watch_errors() {
  const std::uint32_t state = esr() & 7;
  // Rising only: the controller asks for attention when things get worse.
  if ((state & ~last_state_ & ier_ >> 8) != 0) msr_flags_ |= kErrorInterrupt;
  last_state_ = state;
}

std::uint32_t BxCan::tsr() const {
  std::uint32_t value = done_flags_, code = 0;
  for (int i = kMailboxes - 1; i >= 0; --i) {
    const Mailbox& m = mailboxes_[static_cast<std::size_t>(i)];
    if (!m.pending) {
      value |= 1u << (26 + i);
      code = static_cast<std::uint32_t>(i);
    } else if (m.abort_asked) {
      value |= 0x80u << (8 * i);
    }
  }
  return value | code << 24;
}

void BxCan::update_lines() {
  lines_.set_line(kTransmitIrq, (done_flags_ & 0x010101) != 0 && (ier_ & 1) != 0);
  for (unsigned f = 0; f < 2; ++f) {
    const Fifo& fifo = fifos_[f];
    const std::uint32_t enables = ier_ >> (1 + 3 * f);
    lines_.set_line(kFifo0Irq + static_cast<int>(f), (fifo.count > 0 && (enables & 1) != 0) ||
                                                         (fifo.full_flag && (enables & 2) != 0) ||
                                                         (fifo.overrun && (enables & 4) != 0));
  }
  lines_.set_line(kStateIrq, (msr_flags_ & kErrorInterrupt) != 0 && (ier_ & 0x8000) != 0);
}

std::uint32_t BxCan::bit_rate() const {
  const std::uint32_t quanta = 3 + (btr_ >> 16 & 0xF) + (btr_ >> 20 & 7);
  return static_cast<std::uint32_t>(kCoreHz / kApb1Divider) / ((btr_ & 0x3FF) + 1) / quanta;
}

double BxCan::sample_point() const {
  const std::uint32_t segment1 = (btr_ >> 16 & 0xF) + 1, segment2 = (btr_ >> 20 & 7) + 1;
  return static_cast<double>(1 + segment1) / static_cast<double>(1 + segment1 + segment2);
}

std::uint32_t BxCan::read(std::uint32_t offset, Cycle now) {
  advance(now);
  if (offset >= 0x180 && offset < 0x1B0) {
    const Mailbox& m = mailboxes_[(offset - 0x180) / 16];
    const std::array words{m.tir, m.tdtr, m.low, m.high};
    return words[offset / 4 % 4];
  }
  if (offset >= 0x1B0 && offset < 0x1D0) {
    const Stored& s = fifos_[(offset - 0x1B0) / 16].stored[0];
    const std::array words{s.rir, s.rdtr, s.low, s.high};
    return words[offset / 4 % 4];
  }
  if (offset >= CanFilterBanks::kFrom) return filters_.read(offset);
  switch (offset) {
    case 0x00:
      return mcr_;
    case 0x04:
      return (mcr_ & 3) | ((mcr_ & 3) == 0 && !joined_ ? 1u : 0u) | msr_flags_ | 0xC00;
    case 0x08:
      return tsr();
    case 0x0C:
    case 0x10: {
      const Fifo& fifo = fifos_[(offset - 0x0C) / 4];
      return static_cast<std::uint32_t>(fifo.count) | (fifo.full_flag ? kFull : 0) |
             (fifo.overrun ? kOverrun : 0);
    }
    case 0x14:
      return ier_;
    case 0x18:
      return esr();
    case 0x1C:
      return btr_;
    default:
      return 0;
  }
}

void BxCan::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  advance(now);
  if (offset >= 0x180 && offset < 0x1B0) {
    const auto number = static_cast<int>((offset - 0x180) / 16);
    Mailbox& m = mailboxes_[static_cast<std::size_t>(number)];
    if (m.pending) return;  // write-protected while it waits
    switch (offset / 4 % 4) {
      case 0:
        m.tir = value;
        if ((value & kTransmitRequest) != 0) {
          m.pending = true;
          done_flags_ &= ~(0xFu << (8 * number));
          if (listening()) requests_.push_back({now, number, false, frame_of(m)});
        }
        break;
      case 1:
        m.tdtr = value;
        break;
      case 2:
        m.low = value;
        break;
      default:
        m.high = value;
        break;
    }
    update_lines();
    return;
  }
  if (offset >= CanFilterBanks::kFrom) {
    filters_.write(offset, value);
    return;
  }
  switch (offset) {
    case 0x00: {
      if ((value & kSoftwareReset) != 0) {
        reset();
        return;
      }
      const std::uint32_t was = mcr_;
      mcr_ = value & 0x100FF;
      if ((mcr_ & (kInitRequest | kSleepRequest)) == (kInitRequest | kSleepRequest)) mcr_ &= ~kSleepRequest;
      if ((was & kInitRequest) != 0 && (mcr_ & kInitRequest) == 0 && bus_off_) recovers_ = now + kRecovery;
      if ((mcr_ & 3) != 0) {
        joined_ = false;
        joins_ = kNever;
      } else if ((was & 3) != 0) {
        joins_ = dominant_ ? kNever : now + kJoin;
      }
      break;
    }
    case 0x04:
      msr_flags_ &= ~(value & 0x1C);
      break;
    case 0x08:
      for (int i = 0; i < kMailboxes; ++i) {
        if ((value >> (8 * i) & 1) != 0) done_flags_ &= ~(0xFu << (8 * i));
        Mailbox& m = mailboxes_[static_cast<std::size_t>(i)];
        if ((value >> (8 * i) & 0x80) != 0 && m.pending && !m.abort_asked) {
          m.abort_asked = true;
          requests_.push_back({now, i, true, frame_of(m)});
        }
      }
      break;
    case 0x0C:
    case 0x10: {
      Fifo& fifo = fifos_[(offset - 0x0C) / 4];
      if ((value & kOverrun) != 0) fifo.overrun = false;
      if ((value & kFull) != 0) fifo.full_flag = false;
      if ((value & kRelease) != 0 && fifo.count > 0) {
        fifo.stored[0] = fifo.stored[1];
        fifo.stored[1] = fifo.stored[2];
        --fifo.count;
      }
      break;
    }
    case 0x14:
      ier_ = value;
      break;
    case 0x18:
      lec_ = value >> 4 & 7;
      break;
    case 0x1C:
      if ((mcr_ & kInitRequest) != 0) btr_ = value;
      break;
    default:
      return;
  }
  update_lines();
}

}  // namespace kinebus::emulator
