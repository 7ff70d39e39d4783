#include "tools/simulation/bus/bus_model.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>
#include <utility>

#include "protocol/can/bit_length.hpp"

namespace kinebus {
namespace {

/// Lower wins arbitration: the bits as they stand on the wire. A standard frame beats an extended one with
/// the same first 11 bits, a data frame beats a remote one.
std::uint64_t arbitration_value(const CanFrame& frame) {
  const std::uint64_t remote = frame.remote ? 1 : 0;
  if (!frame.extended) return (static_cast<std::uint64_t>(frame.id) << 21) | (remote << 20);
  const std::uint64_t high = frame.id >> 18, low = frame.id & 0x3FFFF;
  return (high << 21) | (3ULL << 19) | (low << 1) | remote;
}

}  // namespace

BusModel::Port BusModel::add_port(int mailboxes) {
  assert(mailboxes >= 1 && mailboxes <= kMaxMailboxes);
  Participant participant;
  participant.size = mailboxes;
  ports_.push_back(participant);
  return static_cast<Port>(ports_.size()) - 1;
}

bool BusModel::has_room(Port port) const {
  const Participant& p = ports_[static_cast<std::size_t>(port)];
  return std::any_of(p.mailboxes.begin(), p.mailboxes.begin() + p.size,
                     [](const Mailbox& m) { return !m.full; });
}

void BusModel::send(Port port, BusTime now, const CanFrame& frame) {
  Participant& p = ports_[static_cast<std::size_t>(port)];
  for (int i = 0; i < p.size; ++i) {
    Mailbox& m = p.mailboxes[static_cast<std::size_t>(i)];
    if (m.full) continue;
    m = {true, order_++, frame};
    ++waiting_;
    if (!on_wire_) arbitrate(std::max(now, free_at_));
    return;
  }
  assert(false && "send() without has_room()");
}

bool BusModel::withdraw(Port port, const CanFrame& frame) {
  Participant& p = ports_[static_cast<std::size_t>(port)];
  for (int i = 0; i < p.size; ++i) {
    Mailbox& m = p.mailboxes[static_cast<std::size_t>(i)];
    if (!m.full || m.frame != frame) continue;
    m.full = false;
    --waiting_;
    return true;
  }
  return false;
}

void BusModel::arbitrate(BusTime start) {
  Mailbox* winner = nullptr;
  Port from = 0;
  const auto rank = [](const Mailbox& m) { return std::tuple(arbitration_value(m.frame), m.order); };
  for (std::size_t port = 0; port < ports_.size(); ++port) {
    if (ports_[port].errors.bus_off()) continue;
    for (Mailbox& m : ports_[port].mailboxes)
      if (m.full && (winner == nullptr || rank(m) < rank(*winner))) {
        winner = &m;
        from = static_cast<Port>(port);
      }
  }
  if (winner == nullptr) return;
  const int bits = bit_length(winner->frame);
  statistics_.frames += 1;
  statistics_.bits += static_cast<std::uint64_t>(bits);
  free_at_ = start + BusTime{bits * ns_per_bit_};
  on_wire_ = Delivery{start + BusTime{(bits - 3) * ns_per_bit_}, from, winner->frame};
  wire_order_ = winner->order;
  abandoned_ = false;
  winner->full = false;
  --waiting_;
}

/// The frame on the wire was destroyed: an error frame, the counters, and the sender tries again.
bool BusModel::spoil() {
  // Error flags superposed, delimiter, intermission: 17 to 31 bits after the one in error.
  constexpr int kErrorBits = 26, kSuspendBits = 8;
  Participant& sender = ports_[static_cast<std::size_t>(on_wire_->from)];
  ++statistics_.errors;
  sender.errors.transmit += 8;
  for (Participant& other : ports_)
    if (&other != &sender) other.errors.receive = std::min(other.errors.receive + 1, 135);
  free_at_ += BusTime{(kErrorBits + (sender.errors.passive() ? kSuspendBits : 0)) * ns_per_bit_};
  statistics_.bits += kErrorBits;
  if (abandoned_) return true;
  const auto end = sender.mailboxes.begin() + kMaxMailboxes;
  const auto room = std::find_if(sender.mailboxes.begin(), end, [](const Mailbox& m) { return !m.full; });
  if (room == end) return true;
  *room = {true, wire_order_, on_wire_->frame};
  ++waiting_;
  return true;
}

void BusModel::clear(Port port) {
  for (Mailbox& m : ports_[static_cast<std::size_t>(port)].mailboxes)
    if (std::exchange(m.full, false)) --waiting_;
  if (on_wire_ && on_wire_->from == port) abandoned_ = true;
}

void BusModel::recover(Port port) {
  clear(port);
  ports_[static_cast<std::size_t>(port)].errors = {};
}

std::optional<BusModel::Delivery> BusModel::advance(BusTime now) {
  if (!on_wire_ || on_wire_->end > now) return std::nullopt;
  const Delivery done = *on_wire_;
  const bool spoilt = destroyed && destroyed(done.end, done.from, done.frame) && spoil();
  on_wire_.reset();
  if (!spoilt)
    for (std::size_t port = 0; port < ports_.size(); ++port) {
      int& counter =
          static_cast<Port>(port) == done.from ? ports_[port].errors.transmit : ports_[port].errors.receive;
      counter = std::max(counter - 1, 0);
    }
  if (waiting_ > 0) arbitrate(free_at_);
  if (spoilt) return std::nullopt;
  return done;
}

}  // namespace kinebus
