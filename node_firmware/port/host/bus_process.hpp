#pragma once
// A simulated node as a Linux process on SocketCAN: the event loop, whatever node is behind it. The kernel's
// receive time stamps stand for the receive interrupt, a timer for the timer, a file for the flash.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "node_firmware/port/host/image_file.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/host/socketcan.hpp"

namespace kinebus {

class BusProcess {
 public:
  BusProcess(std::string interface, std::string image_path);
  BusProcess(const BusProcess&) = delete;
  BusProcess& operator=(const BusProcess&) = delete;
  virtual ~BusProcess();

  /// Empty: ready. Otherwise what is wrong and what to do.
  std::string open();
  /// Until SIGTERM or SIGINT: empty. Otherwise why it could not go on.
  std::string run();

 protected:
  /// Identifier 0: none.
  using Wanted = std::array<SocketCan::Accept, 1 + 1 + 2 + kRpdoCount>;
  /// Requests and PDOs of a node, remote frames of node guarding, and the heartbeats that it watches.
  template <typename AnyNode>
  static Wanted wanted_of(const AnyNode& node) {
    Wanted wanted{};
    if (node.node_id() == 0) return wanted;
    std::size_t count = 0;
    const auto add = [&](std::uint32_t id, bool remote = false) {
      wanted[count++] = {.value = static_cast<std::uint16_t>(id), .remote = remote};
    };
    add(cob_id::kSdoRequest + node.node_id());
    if constexpr (requires { node.answers_guarding(); })
      if (node.answers_guarding()) add(cob_id::kHeartbeat + node.node_id(), true);
    for (const std::uint8_t id : node.watched_nodes()) add(id == 0 ? 0 : cob_id::kHeartbeat + id);
    for (const std::uint16_t id : node.rpdo_cob_ids()) add(id);
    return wanted;
  }

  // What a node is to its process; called with CLOCK_MONOTONIC as its local time.
  /// Begins, with what its flash holds. Empty: ready.
  virtual std::string start(LocalTime now, std::span<const std::uint8_t> stored) = 0;
  virtual void on_frame(LocalTime at, const CanFrame& frame) = 0;
  virtual void on_time(LocalTime now) = 0;
  virtual std::optional<CanFrame> next_frame() = 0;
  virtual LocalTime next_deadline() = 0;
  virtual std::span<const std::uint8_t> image_to_store() = 0;
  virtual void on_image_stored(bool good) = 0;
  virtual bool take_reset_request() = 0;
  /// What the board's controller passes on besides NMT, LSS, SYNC, EMCY and a session's vouchers.
  virtual Wanted wanted() = 0;
  virtual void on_user_signal() {}
  /// A line of standard input, as far as the node listens to it (see listen()).
  virtual void on_line(std::string_view) {}
  /// To be called from start(): lines of standard input are commands.
  void listen() { listening_ = true; }

 private:
  void receive();
  void filter();
  void send();
  void store();
  void arm_timer();
  void read_lines();
  /// True: end.
  bool on_signal();
  std::string watch(int fd);

  std::string interface_;
  SocketCan can_;
  ImageFile image_;
  std::array<SocketCan::Accept, 16> filters_{};
  std::optional<CanFrame> unsent_;
  bool bus_down_ = false, listening_ = false;
  std::string line_;
  int epoll_ = -1, timer_ = -1, signals_ = -1;
};

}  // namespace kinebus
