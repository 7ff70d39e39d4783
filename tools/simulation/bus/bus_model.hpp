#pragma once
// A CAN bus in virtual time: arbitration by identifier, frame lengths to the bit (stuffing included), and the
// simultaneous end of frame for everybody. Errors on the wire destroy a frame for everybody; it is sent
// again, and the error counters of ISO 11898-1 decide who becomes error-passive or bus-off. Used by the
// simulation and by the daemon's bus inside the process.

#include <array>
#include <cstdint>
#include <functional>
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
    std::uint64_t bits = 0;    ///< intermission included
    std::uint64_t errors = 0;  ///< frames destroyed
  };

  explicit BusModel(std::int64_t bits_per_s = 1'000'000) : ns_per_bit_(1'000'000'000 / bits_per_s) {}

  /// A participant with so many transmit mailboxes (a bxCAN has 3).
  Port add_port(int mailboxes);
  bool has_room(Port port) const;
  /// Puts a frame into a mailbox; has_room() must hold. `now` must not be before the last delivery's end.
  void send(Port port, BusTime now, const CanFrame& frame);

  /// Takes a waiting frame out of its mailbox again. False: it is on the wire already, or not there.
  bool withdraw(Port port, const CanFrame& frame);
  /// ISO 11898-1: transmit and receive error counters of a participant.
  struct Errors {
    int transmit = 0, receive = 0;
    bool passive() const { return transmit > 127 || receive > 127; }
    bool bus_off() const { return transmit > 255; }
  };
  /// Asked at the end of every frame whether it was destroyed by a bit error.
  std::function<bool(BusTime end, Port from, const CanFrame&)> destroyed;
  const Errors& errors(Port port) const { return ports_[static_cast<std::size_t>(port)].errors; }
  /// After bus-off (128 times 11 recessive bits are taken as passed): counters at zero, mailboxes empty.
  void recover(Port port);
  /// What waits in its mailboxes is gone: the participant has lost its power, or has been reset.
  void clear(Port port);

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
    Errors errors;
  };
  bool spoil();

  void arbitrate(BusTime start);

  std::int64_t ns_per_bit_;
  std::vector<Participant> ports_;
  std::optional<Delivery> on_wire_;
  std::uint64_t wire_order_ = 0;
  bool abandoned_ = false;  // the sender of what is on the wire has gone meanwhile: it is not sent again
  BusTime free_at_{0};      // the intermission after the last frame ends
  int waiting_ = 0;
  std::uint64_t order_ = 0;
  Statistics statistics_;
};

}  // namespace kinebus
