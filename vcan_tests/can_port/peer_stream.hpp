#pragma once
// Bytes to and from another process: a Unix socket or, in a guest, a virtio-serial port.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace kinebus {

/// Never blocks, but in wait().
class PeerStream {
 public:
  PeerStream() = default;
  /// Takes the descriptor.
  explicit PeerStream(int fd) { take(fd); }
  ~PeerStream();
  PeerStream(const PeerStream&) = delete;
  PeerStream& operator=(const PeerStream&) = delete;

  /// A Unix socket that somebody listens at, or a device. Empty: open. Otherwise what is wrong.
  std::string open(const std::string& path);
  /// Makes the Unix socket: who sees it can open() it from now on. Empty: made. Otherwise what is wrong.
  std::string listen_at(const std::string& path);
  /// After listen_at(): waits for the one who connects. Empty: open. Otherwise what is wrong.
  std::string wait();

  int fd() const { return fd_; }
  /// How many bytes came, or went; 0: none now.
  std::size_t read(std::span<std::uint8_t> bytes);
  std::size_t write(std::span<const std::uint8_t> bytes);
  /// The other end is gone, or `trouble` says what is wrong.
  bool closed() const { return closed_; }
  const std::string& trouble() const { return trouble_; }

 private:
  void take(int fd);
  void fail(const char* what);

  std::string path_, trouble_;
  int listener_ = -1, fd_ = -1;
  bool socket_ = false, closed_ = false;
};

}  // namespace kinebus
