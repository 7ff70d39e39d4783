#include "protocol/host/bus_model.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>

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
  for (std::size_t port = 0; port < ports_.size(); ++port)
    for (Mailbox& m : ports_[port].mailboxes)
      if (m.full && (winner == nullptr || rank(m) < rank(*winner))) {
        winner = &m;
        from = static_cast<Port>(port);
      }
  if (winner == nullptr) return;
  const int bits = bit_length(winner->frame);
  statistics_.frames += 1;
  statistics_.bits += static_cast<std::uint64_t>(bits);
  free_at_ = start + BusTime{bits * ns_per_bit_};
  on_wire_ = Delivery{start + BusTime{(bits - 3) * ns_per_bit_}, from, winner->frame};
  winner->full = false;
  --waiting_;
}

std::optional<BusModel::Delivery> BusModel::advance(BusTime now) {
  if (!on_wire_ || on_wire_->end > now) return std::nullopt;
  const Delivery done = *on_wire_;
  on_wire_.reset();
  if (waiting_ > 0) arbitrate(free_at_);
  return done;
}

}  // namespace kinebus
