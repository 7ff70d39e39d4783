#include "gateway/io/usb/fd_stream.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace kinebus {

FdStream::~FdStream() {
  ::close(fd_);
  if (gone_) gone_();
}

ByteStream::Moved FdStream::failed() {
  if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return {};
  // A tty whose cable was pulled, a peer that reset: the ordinary ends of such streams.
  if (errno != EIO && errno != EPIPE && errno != ECONNRESET) reason_ = std::strerror(errno);
  return {.count = 0, .closed = true};
}

ByteStream::Moved FdStream::read(std::span<std::uint8_t> buffer) {
  const ssize_t count = ::read(fd_, buffer.data(), buffer.size());
  if (count < 0) return failed();
  return {.count = static_cast<std::size_t>(count), .closed = count == 0};
}

ByteStream::Moved FdStream::write(std::span<const std::uint8_t> bytes) {
  const ssize_t count = ::write(fd_, bytes.data(), bytes.size());
  if (count < 0) return failed();
  return {.count = static_cast<std::size_t>(count)};
}

}  // namespace kinebus
