#pragma once
// What the daemon needs of a bus, whether SocketCAN or the one inside the process.

#include <optional>
#include <string>

#include "protocol/can/frame.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class BusPort {
 public:
  struct Received {
    enum class Kind : std::uint8_t { kFrame, kSent, kFailure } kind{};
    LocalTime when{0};
    CanFrame frame{};
    std::string failure{};  ///< kFailure: in words
  };

  virtual ~BusPort() = default;
  virtual int fd() const = 0;  ///< readable when receive() may have something; -1: only by next_deadline()
  virtual LocalTime next_deadline() const = 0;
  /// True: a frame given now would leave at once or soon; frames wait as short as possible where their order
  /// is fixed.
  virtual bool can_send(LocalTime now) = 0;
  virtual void send(LocalTime now, const CanFrame& frame) = 0;
  virtual std::optional<Received> receive(LocalTime now) = 0;
};

}  // namespace kinebus
