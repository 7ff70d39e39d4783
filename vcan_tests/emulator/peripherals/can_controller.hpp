#pragma once
// A CAN controller as the bus sees it, whatever its registers: it asks for frames to be sent, and is told
// what was sent, what came, and what went wrong.

#include <cstdint>
#include <vector>

#include "protocol/can/frame.hpp"
#include "vcan_tests/emulator/cycle.hpp"

namespace kinebus::emulator {

class CanController {
 public:
  static constexpr int kMailboxes = 3;

  struct Request {  // from the program to the bus
    Cycle at = 0;
    int mailbox = 0;
    bool abort = false;
    CanFrame frame;
  };
  struct Counters {
    std::uint64_t sent = 0, received = 0, accepted = 0, overruns = 0, bus_offs = 0;
  };

  virtual ~CanController() = default;
  /// What the program has asked for since the last call, in order.
  virtual std::vector<Request> take_requests() = 0;
  virtual void on_sent(int mailbox) = 0;
  virtual void on_aborted(int mailbox) = 0;
  /// A frame ends on the bus.
  virtual void on_frame(const CanFrame& frame, Cycle now) = 0;
  /// An error frame while sending or receiving (ISO 11898-1's counting, its special cases left out).
  virtual void on_error(bool sending, Cycle now) = 0;
  /// Nobody has acknowledged what it sent: an error, which a passive sender does not count.
  virtual void on_no_acknowledge(Cycle now) = 0;
  virtual bool bus_off() const = 0;
  /// It takes part in the bus, and acknowledges what others send.
  virtual bool listening() const = 0;
};

}  // namespace kinebus::emulator
