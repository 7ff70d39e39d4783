#pragma once
// A stream of bytes to some client: local socket, TCP with TLS, USB endpoints, serial port, pty. Never
// blocks. Who makes one (a listener, a gadget that was enabled, a tty that was opened) gives it to
// StreamHub::add() together with the session that speaks on it; the hub owns both until one of them ends.

#include <sys/epoll.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace kinebus {

class ByteStream {
 public:
  /// count > 0: bytes moved. count == 0: nothing now, unless closed. After `closed` nothing more comes.
  struct Moved {
    std::size_t count = 0;
    bool closed = false;
  };

  virtual ~ByteStream() = default;
  /// What epoll waits on: the same fd for the whole life of the stream.
  virtual int fd() const = 0;
  /// The epoll bits to wait for now. A stream on an eventfd (asynchronous USB endpoints) always answers
  /// EPOLLIN and makes the fd readable both for data and for room.
  virtual std::uint32_t interest(bool output_waits) const {
    return output_waits ? std::uint32_t{EPOLLIN | EPOLLOUT} : std::uint32_t{EPOLLIN};
  }
  virtual Moved read(std::span<std::uint8_t> buffer) = 0;
  /// read() has something though the fd is not readable (decrypted already).
  virtual bool buffered() const { return false; }
  virtual Moved write(std::span<const std::uint8_t> bytes) = 0;
  /// Why it closed, in words; empty: the other side ended it.
  virtual std::string closed_reason() const { return {}; }
};

}  // namespace kinebus
