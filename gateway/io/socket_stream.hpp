#pragma once
// Sockets as streams: the local socket, and the plain part of TCP.

#include <memory>
#include <string>

#include "gateway/io/byte_stream.hpp"
#include "gateway/result.hpp"

namespace kinebus {

class SocketStream : public ByteStream {
 public:
  /// Takes over a connected, non-blocking socket.
  explicit SocketStream(int fd) : fd_(fd) {}
  ~SocketStream() override;
  SocketStream(const SocketStream&) = delete;
  SocketStream& operator=(const SocketStream&) = delete;

  int fd() const override { return fd_; }
  Moved read(std::span<std::uint8_t> buffer) override;
  Moved write(std::span<const std::uint8_t> bytes) override;
  std::string closed_reason() const override { return reason_; }

 private:
  Moved failed();
  int fd_;
  std::string reason_;
};

/// To a local socket. Error: in words.
Result<std::unique_ptr<ByteStream>, std::string> connect_local(const std::string& path);
/// A connected, non-blocking TCP socket; waits for the connection. Error: in words.
Result<int, std::string> connect_tcp(const std::string& host, const std::string& port);

}  // namespace kinebus
