#pragma once
// Where clients knock: the local socket, and a TCP port. Who is let in becomes a stream.

#include <functional>
#include <memory>
#include <string>

#include "gateway/io/byte_stream.hpp"
#include "gateway/io/event_loop.hpp"
#include "gateway/io/work_gate.hpp"

namespace kinebus {

class Listener {
 public:
  /// A connected, non-blocking socket and who it is ("local", "tcp 10.0.0.7"): the handler owns the socket.
  using OnClient = std::function<void(int fd, std::string who)>;

  Listener(EventLoop& loop, OnClient on_client) : loop_(loop), on_client_(std::move(on_client)) {}
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Only the owner may connect, and the members of `group` unless it is empty. Empty: listening.
  std::string listen_local(const std::string& path, const std::string& group);
  /// `address`: "0.0.0.0:7411", "[::1]:7411", ":7411" for all. Empty: listening.
  std::string listen_tcp(const std::string& address);
  /// Why listen_tcp failed: another program has the port.
  bool taken() const { return taken_; }
  /// Whom it does not let in waits at the port.
  void pass(WorkGate& gate) { gate_ = &gate; }
  /// The port in use (TCP).
  int port() const;
  /// Where the loop waits for clients; -1: it does not listen.
  int fd() const { return fd_; }
  /// Only programs of this computer can connect (TCP).
  bool loopback() const;

 private:
  void on_knock();
  void accept_client();
  EventLoop& loop_;
  OnClient on_client_;
  WorkGate* gate_ = nullptr;
  int fd_ = -1;
  bool taken_ = false;
  std::string path_;
};

/// Whose places a connection takes: "local uid 1000", "tcp 10.0.0.7", "tcp 2001:db8::/64" (one computer has
/// as many addresses of such a net as it likes).
std::string peer_of(int fd);

}  // namespace kinebus
