#include "vcan_tests/can_port/can_port.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "protocol/host/kernel_frame.hpp"

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

void CanPort::close(std::string trouble) {
  if (closed_) return;
  closed_ = true;
  trouble_ = std::move(trouble);
}

std::string InterfacePort::open(const std::string& interface) {
  interface_ = interface;
  return can_.open(interface, false);
}

bool InterfacePort::send(const CanFrame& frame) {
  const SocketCan::Sent sent = can_.send(frame);
  if (sent == SocketCan::Sent::kDown) close(interface_ + " went down");
  return sent == SocketCan::Sent::kYes;
}

std::optional<CanPort::Received> InterfacePort::receive() {
  while (const auto got = can_.receive()) {
    if (got->kind == SocketCan::Kind::kFrame) return Received{got->when, got->frame};
    if (got->kind != SocketCan::Kind::kDown) continue;
    close(interface_ + " went down");
    break;
  }
  return std::nullopt;
}

pollfd InterfacePort::waits_for(bool frames) const {
  return {can_.fd(), static_cast<short>(frames ? POLLIN : 0), 0};
}

StreamPort::StreamPort(int fd) {
  take(fd);
}

StreamPort::~StreamPort() {
  if (listener_ >= 0) ::close(listener_);
  if (fd_ >= 0) ::close(fd_);
}

void StreamPort::take(int fd) {
  static_assert(sizeof(can_frame) == kFrameBytes);
  fd_ = fd;
  ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
  struct stat kind {};
  socket_ = ::fstat(fd, &kind) == 0 && S_ISSOCK(kind.st_mode);
}

std::string StreamPort::open(const std::string& path) {
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

std::string StreamPort::listen_at(const std::string& path) {
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

std::string StreamPort::wait() {
  int fd = -1;
  while (fd < 0 && (fd = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC)) < 0 && errno == EINTR) {
  }
  if (fd < 0) return because(path_, "nobody came");
  ::close(std::exchange(listener_, -1));
  take(fd);
  return {};
}

bool StreamPort::send(const CanFrame& frame) {
  if (closed()) return false;
  if (out_.size() - out_end_ < kFrameBytes) flush();
  if (out_.size() - out_end_ < kFrameBytes) return false;
  const can_frame raw = to_kernel(frame);
  std::memcpy(out_.data() + out_end_, &raw, kFrameBytes);
  out_end_ += kFrameBytes;
  return true;
}

void StreamPort::flush() {
  while (!closed() && out_begin_ < out_end_) {
    const std::uint8_t* const from = out_.data() + out_begin_;
    const std::size_t size = out_end_ - out_begin_;
    const ssize_t count = socket_ ? ::send(fd_, from, size, MSG_NOSIGNAL) : ::write(fd_, from, size);
    if (count > 0)
      out_begin_ += static_cast<std::size_t>(count);
    else if (count < 0 && (errno == EPIPE || errno == ECONNRESET))
      close({});
    else if (count < 0 && errno != EINTR && errno != EAGAIN)
      close(std::string("frames cannot be written: ") + std::strerror(errno));
    else if (count == 0 || errno == EAGAIN)
      break;
  }
  std::copy(out_.data() + out_begin_, out_.data() + out_end_, out_.data());
  out_end_ -= out_begin_;
  out_begin_ = 0;
}

/// Reads until a whole frame is there. False: not yet, or never.
bool StreamPort::fill() {
  std::copy(in_.data() + in_begin_, in_.data() + in_end_, in_.data());
  in_end_ -= in_begin_;
  in_begin_ = 0;
  while (!closed() && in_end_ < kFrameBytes) {
    const ssize_t count = ::read(fd_, in_.data() + in_end_, in_.size() - in_end_);
    if (count > 0)
      in_end_ += static_cast<std::size_t>(count);
    else if (count == 0 || errno == ECONNRESET)
      close(in_end_ == 0 ? "" : "the stream ended within a frame");
    else if (errno == EAGAIN)
      return false;
    else if (errno != EINTR)
      close(std::string("frames cannot be read: ") + std::strerror(errno));
  }
  return in_end_ >= kFrameBytes;
}

std::optional<CanPort::Received> StreamPort::receive() {
  if (in_end_ - in_begin_ < kFrameBytes && !fill()) return std::nullopt;
  can_frame raw{};
  std::memcpy(&raw, in_.data() + in_begin_, kFrameBytes);
  in_begin_ += kFrameBytes;
  if (raw.can_dlc > 8 || (raw.can_id & CAN_ERR_FLAG) != 0) {
    in_begin_ = in_end_ = 0;
    close("what came is no frame: expected struct can_frame with at most 8 data bytes");
    return std::nullopt;
  }
  return Received{monotonic_now(), from_kernel(raw)};
}

pollfd StreamPort::waits_for(bool frames) const {
  const int events = (frames ? POLLIN : 0) | (out_end_ > out_begin_ ? POLLOUT : 0);
  return {fd_, static_cast<short>(events), 0};
}

std::uint64_t OneWay::pass(CanPort& from, CanPort& to) {
  std::uint64_t passed = 0;
  for (;; ++passed) {
    if (!waiting_) {
      const auto got = from.receive();
      if (!got) break;
      waiting_ = got->frame;
    }
    if (!to.send(*waiting_)) break;
    waiting_.reset();
  }
  to.flush();
  return passed;
}

}  // namespace kinebus
