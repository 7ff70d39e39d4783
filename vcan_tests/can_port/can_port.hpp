#pragma once
// One end of a CAN bus as a program has it: a SocketCAN interface, or a byte stream to who has one.

#include <poll.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "protocol/can/frame.hpp"
#include "protocol/host/socketcan.hpp"
#include "protocol/time.hpp"
#include "vcan_tests/can_port/peer_stream.hpp"

namespace kinebus {

/// Never blocks.
class CanPort {
 public:
  struct Received {
    LocalTime when{0};
    CanFrame frame;
  };

  CanPort() = default;
  CanPort(const CanPort&) = delete;
  CanPort& operator=(const CanPort&) = delete;
  virtual ~CanPort() = default;

  /// False: no room now, offer it again later.
  virtual bool send(const CanFrame& frame) = 0;
  /// What was sent goes out, as far as there is room.
  virtual void flush() {}
  virtual std::optional<Received> receive() = 0;
  /// What poll() shall wait for: frames, if wanted, and room when something waits to go out.
  virtual pollfd waits_for(bool frames) const = 0;

  /// Nothing comes or goes any more: the other side ended, or `trouble` says what is wrong.
  bool closed() const { return closed_; }
  const std::string& trouble() const { return trouble_; }

 protected:
  void close(std::string trouble);

 private:
  bool closed_ = false;
  std::string trouble_;
};

/// A SocketCAN interface; received frames have the kernel's time stamp.
class InterfacePort final : public CanPort {
 public:
  /// Empty: open. Otherwise what is wrong and what to do.
  std::string open(const std::string& interface);

  bool send(const CanFrame& frame) override;
  std::optional<Received> receive() override;
  pollfd waits_for(bool frames) const override;
  /// Frames that the kernel dropped because nobody fetched them.
  std::uint32_t lost() const { return can_.counters().rx_overflow; }

 private:
  std::string interface_;
  SocketCan can_;
};

/// Frames as struct can_frame (16 bytes, this computer's byte order) on a byte stream, either way. Received
/// frames have the time at which they were read.
class StreamPort final : public CanPort {
 public:
  StreamPort() = default;
  /// Takes the descriptor.
  explicit StreamPort(int fd) : stream_(fd) {}

  // As PeerStream has them.
  std::string open(const std::string& path) { return stream_.open(path); }
  std::string listen_at(const std::string& path) { return stream_.listen_at(path); }
  std::string wait() { return stream_.wait(); }

  bool send(const CanFrame& frame) override;
  void flush() override;
  std::optional<Received> receive() override;
  pollfd waits_for(bool frames) const override;

 private:
  static constexpr std::size_t kFrameBytes = 16;
  bool fill();

  PeerStream stream_;
  std::array<std::uint8_t, 256 * kFrameBytes> in_{}, out_{};
  std::size_t in_begin_ = 0, in_end_ = 0, out_begin_ = 0, out_end_ = 0;
};

/// One direction of what joins two ports: a frame is fetched only when the one before it has left.
class OneWay {
 public:
  /// Passes on what it can. Returns how many frames.
  std::uint64_t pass(CanPort& from, CanPort& to);
  bool waits() const { return waiting_.has_value(); }

 private:
  std::optional<CanFrame> waiting_;
};

}  // namespace kinebus
