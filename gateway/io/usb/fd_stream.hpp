#pragma once
// A stream on one file descriptor: a tty, a pty's master, a socket.

#include <functional>

#include "gateway/io/byte_stream.hpp"

namespace kinebus {

class FdStream : public ByteStream {
 public:
  /// Takes the fd, which must not block. `gone` is called when the stream is destroyed.
  explicit FdStream(int fd, std::function<void()> gone = {}) : fd_(fd), gone_(std::move(gone)) {}
  ~FdStream() override;
  FdStream(const FdStream&) = delete;
  FdStream& operator=(const FdStream&) = delete;

  int fd() const override { return fd_; }
  Moved read(std::span<std::uint8_t> buffer) override;
  Moved write(std::span<const std::uint8_t> bytes) override;
  std::string closed_reason() const override { return reason_; }

 private:
  Moved failed();

  int fd_;
  std::function<void()> gone_;
  std::string reason_;
};

}  // namespace kinebus
