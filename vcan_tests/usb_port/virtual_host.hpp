#pragma once
// This computer's own USB as the place of a device that is a program: Linux's vhci_hcd takes what speaks
// USB/IP over a socket for a device at a cable of its own, so that its real drivers are the device's host.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinebus {

class VirtualHost {
 public:
  VirtualHost() = default;
  ~VirtualHost() { detach(); }
  VirtualHost(const VirtualHost&) = delete;
  VirtualHost& operator=(const VirtualHost&) = delete;

  /// A full-speed device appears at the first port. If it is not attached() then and there is no error, the
  /// one before it is not quite gone: again later.
  void attach();
  /// It is gone, as if the cable had been pulled.
  void detach();
  bool attached() const { return fd_ >= 0; }

  /// Adds what Linux says in USB/IP. False: it has let go of the device, or of the socket.
  bool receive(std::vector<std::uint8_t>& bytes);
  void send(std::span<const std::uint8_t> bytes);
  int fd() const { return fd_; }
  /// What does not work here, such as no vhci_hcd; empty: nothing.
  const std::string& error() const { return error_; }

 private:
  std::string error_;
  int fd_ = -1;
};

}  // namespace kinebus
