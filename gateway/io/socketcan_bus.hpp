#pragma once
// A SocketCAN interface as the daemon's bus.

#include <memory>
#include <string>

#include "gateway/io/bus_port.hpp"
#include "gateway/result.hpp"
#include "protocol/host/socketcan.hpp"

namespace kinebus {

class SocketCanBus : public BusPort {
 public:
  /// What is wrong with an interface that can be opened is told in the log.
  static Result<std::unique_ptr<SocketCanBus>, std::string> open(const std::string& interface);

  int fd() const override { return socket_.fd(); }
  LocalTime next_deadline() const override;
  bool can_send(LocalTime now) override;
  void send(LocalTime now, const CanFrame& frame) override;
  std::optional<Received> receive(LocalTime now) override;

 private:
  void tell_what_is_wrong() const;

  std::string interface_;
  SocketCan socket_;
  int in_flight_ = 0;  ///< sent by us, not yet seen on the bus
  LocalTime last_sent_{0};
  LocalTime full_until_{0};  ///< the kernel's queue was full
  std::optional<CanFrame> refused_;
  std::optional<LocalTime> looks_at_;  ///< it went down: whether another one has come in its place
  bool down_told_ = false;             ///< and nothing has come since
};

}  // namespace kinebus
