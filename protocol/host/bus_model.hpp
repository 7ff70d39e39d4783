#pragma once
// A CAN bus in virtual time: arbitration by identifier, frame lengths to the bit (stuffing included), and the
// simultaneous end of frame for everybody. Used by the simulation and by the daemon's bus inside the process.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/can/frame.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class BusModel {
 public:
  using Port = int;
  struct Delivery {
    BusTime end{0};  ///< end of frame: receivers have it now
    Port from = 0;
    CanFrame frame;
  };
  struct Statistics {
    std::uint64_t frames = 0;
    std::uint64_t bits = 0;  ///< intermission included
  };

  explicit BusModel(std::int64_t bits_per_s = 1'000'000) : ns_per_bit_(1'000'000'000 / bits_per_s) {}

  /// A participant with so many transmit mailboxes (a bxCAN has 3).
  Port add_port(int mailboxes);
  bool has_room(Port port) const;
  /// Puts a frame into a mailbox; has_room() must hold. `now` must not be before the last delivery's end.
  void send(Port port, BusTime now, const CanFrame& frame);

  /// Takes a waiting frame out of its mailbox again. False: it is on the wire already, or not there.
  bool withdraw(Port port, const CanFrame& frame);

  /// When the frame on the wire ends; max() on an idle bus.
  BusTime next_event() const { return on_wire_ ? on_wire_->end : BusTime::max(); }
  /// The frame that has ended by `now`, if any. Its sender's mailbox is free again.
  std::optional<Delivery> advance(BusTime now);

  const Statistics& statistics() const { return statistics_; }

 private:
  struct Mailbox {
    bool full = false;
    std::uint64_t order = 0;  // first come, first served among equal identifiers of one port
    CanFrame frame;
  };
  static constexpr int kMaxMailboxes = 4;
  struct Participant {
    int size = 0;
    std::array<Mailbox, kMaxMailboxes> mailboxes{};
  };

  void arbitrate(BusTime start);

  std::int64_t ns_per_bit_;
  std::vector<Participant> ports_;
  std::optional<Delivery> on_wire_;
  BusTime free_at_{0};  // the intermission after the last frame ends
  int waiting_ = 0;
  std::uint64_t order_ = 0;
  Statistics statistics_;
};

}  // namespace kinebus
