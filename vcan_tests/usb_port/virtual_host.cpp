#include "vcan_tests/usb_port/virtual_host.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace kinebus {
namespace {

constexpr const char* kAttach = "/sys/devices/platform/vhci_hcd.0/attach";
constexpr int kFullSpeed = 2, kDevice = 0x10001;

}  // namespace

void VirtualHost::attach() {
  std::array<int, 2> ends{-1, -1};
  const int port = ::open(kAttach, O_WRONLY | O_CLOEXEC);
  if (port < 0 || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    error_ = std::string(kAttach) + ": " + std::strerror(errno) + " (modprobe vhci-hcd, as root)";
    if (port >= 0) ::close(port);
    return;
  }
  const std::string words =
      "0 " + std::to_string(ends[1]) + ' ' + std::to_string(kDevice) + ' ' + std::to_string(kFullSpeed);
  const bool good = ::write(port, words.data(), words.size()) == static_cast<ssize_t>(words.size());
  // Of the device before something is left for a moment.
  if (!good && errno != EBUSY) error_ = std::string(kAttach) + ": cannot attach: " + std::strerror(errno);
  ::close(port);
  ::close(ends[1]);
  if (good)
    fd_ = ends[0];
  else
    ::close(ends[0]);
}

void VirtualHost::detach() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

bool VirtualHost::receive(std::vector<std::uint8_t>& bytes) {
  std::array<std::uint8_t, 4096> some{};
  for (;;) {
    const ssize_t count = ::recv(fd_, some.data(), some.size(), MSG_DONTWAIT);
    if (count == 0) return false;
    if (count < 0) return errno == EAGAIN || errno == EINTR;
    bytes.insert(bytes.end(), some.begin(), some.begin() + count);
  }
}

void VirtualHost::send(std::span<const std::uint8_t> bytes) {
  if (::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(bytes.size()) &&
      errno != EPIPE && errno != ECONNRESET)
    error_ = std::string("USB/IP: ") + std::strerror(errno);
}

}  // namespace kinebus
