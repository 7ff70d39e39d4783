#pragma once
// A USB cable as a byte stream: at one end a device (kinebus-emulate), at the other a computer
// (kinebus-usb-port). What goes along it is USB/IP, in pieces that say when the plug is in, and of which
// session they are: what was under way when it was pulled is not taken for what comes after.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vcan_tests/can_port/peer_stream.hpp"

namespace kinebus {

class CableStream {
 public:
  enum class Kind : std::uint8_t {
    kPlugged,   ///< by the computer's end: the cable is in the board's connector
    kPulled,    ///< it is no longer
    kAttached,  ///< by the device's end: a device is there, and this session begins
    kDetached,  ///< it has gone, or heard that the cable is pulled
    kData,
  };
  struct Piece {
    Kind kind{};
    std::uint8_t session = 0;
    std::vector<std::uint8_t> bytes;
  };

  CableStream() = default;
  /// Takes the descriptor.
  explicit CableStream(int fd) : stream_(fd) {}
  PeerStream& stream() { return stream_; }

  /// Waits for room, if there is none: at most a second without any.
  void send(Kind kind, std::uint8_t session, std::span<const std::uint8_t> bytes = {});
  std::optional<Piece> receive();
  /// Nothing comes or goes any more: the other end has ended, or `trouble` says what is wrong.
  bool closed() const { return stream_.closed() || !trouble_.empty(); }
  const std::string& trouble() const { return trouble_.empty() ? stream_.trouble() : trouble_; }

 private:
  static constexpr std::size_t kHeader = 4;
  void write(std::span<const std::uint8_t> bytes);

  PeerStream stream_;
  std::string trouble_;
  std::vector<std::uint8_t> in_;
};

}  // namespace kinebus
