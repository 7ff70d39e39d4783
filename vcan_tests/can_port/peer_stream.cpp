#include "vcan_tests/can_port/peer_stream.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace kinebus {
namespace {

std::string because(const std::string& path, const char* what) {
  return path + ": " + what + ": " + std::strerror(errno);
}

/// A Unix socket's address; empty family: the path is too long.
sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  if (path.size() >= sizeof address.sun_path) return address;
  address.sun_family = AF_UNIX;
  std::copy(path.begin(), path.end(), address.sun_path);
  return address;
}

std::string too_long(const std::string& path) {
  return path + ": a Unix socket's path has at most 103 characters";
}

}  // namespace

PeerStream::~PeerStream() {
  if (listener_ >= 0) ::close(listener_);
  if (fd_ >= 0) ::close(fd_);
}

void PeerStream::take(int fd) {
  fd_ = fd;
  ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
  struct stat kind {};
  socket_ = ::fstat(fd, &kind) == 0 && S_ISSOCK(kind.st_mode);
}

std::string PeerStream::open(const std::string& path) {
  struct stat kind {};
  if (::stat(path.c_str(), &kind) != 0) return because(path, "the other end of the bus");
  if (!S_ISSOCK(kind.st_mode)) {
    const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return because(path, "cannot be opened");
    take(fd);
    return {};
  }
  const sockaddr_un address = address_of(path);
  if (address.sun_family == 0) return too_long(path);
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return because(path, "no socket");
  std::string error;
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    take(fd);
  } else {
    error = because(path, "nobody listens");
    ::close(fd);
  }
  return error;
}

std::string PeerStream::listen_at(const std::string& path) {
  // Under its own name only when it listens: who sees it can connect.
  const std::string before = path + ".new";
  const sockaddr_un address = address_of(before);
  if (address.sun_family == 0) return too_long(path);
  const int listener = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (listener < 0) return because(path, "no socket");
  ::unlink(before.c_str());
  if (::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener, 1) != 0 || ::rename(before.c_str(), path.c_str()) != 0) {
    std::string error = because(path, "the socket cannot be made");
    ::close(listener);
    return error;
  }
  path_ = path;
  listener_ = listener;
  return {};
}

std::string PeerStream::wait() {
  int fd = -1;
  while (fd < 0 && (fd = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC)) < 0 && errno == EINTR) {
  }
  if (fd < 0) return because(path_, "nobody came");
  ::close(std::exchange(listener_, -1));
  take(fd);
  return {};
}

void PeerStream::fail(const char* what) {
  closed_ = true;
  if (errno != EPIPE && errno != ECONNRESET) trouble_ = std::string(what) + ": " + std::strerror(errno);
}

std::size_t PeerStream::read(std::span<std::uint8_t> bytes) {
  while (!closed_ && !bytes.empty()) {
    const ssize_t count = ::read(fd_, bytes.data(), bytes.size());
    if (count > 0) return static_cast<std::size_t>(count);
    if (count == 0) closed_ = true;
    if (count < 0 && errno == EAGAIN) break;
    if (count < 0 && errno != EINTR) fail("nothing can be read");
  }
  return 0;
}

std::size_t PeerStream::write(std::span<const std::uint8_t> bytes) {
  while (!closed_ && !bytes.empty()) {
    const ssize_t count = socket_ ? ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL)
                                  : ::write(fd_, bytes.data(), bytes.size());
    if (count > 0) return static_cast<std::size_t>(count);
    if (count == 0 || errno == EAGAIN) break;
    if (errno != EINTR) fail("nothing can be written");
  }
  return 0;
}

}  // namespace kinebus
