#pragma once
// One conversation on one byte stream, sans-IO: the job link's and the serial port's sessions look the same
// to whoever moves the bytes (gateway/io/stream_hub.hpp).

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "protocol/time.hpp"

namespace kinebus {

class ByteSession {
 public:
  /// How soon it deserves to be heard: who may stop the machine has shown who it is before.
  enum class Rank : std::uint8_t { kAny, kMayStop, kInControl };

  virtual ~ByteSession() = default;

  /// Takes what came; what it asks for may be left to on_time(), a bounded part at a time.
  virtual void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) = 0;
  virtual void on_time(LocalTime now) = 0;
  virtual LocalTime next_deadline() const = 0;
  /// Nobody listened for a while until now, and the other side may not have run either: whoever has to speak
  /// or to read within a time has all of it anew.
  virtual void on_absence(LocalTime /*now*/) {}
  /// What to send now; empty: nothing. Valid until the next call of anything here.
  virtual std::span<const std::uint8_t> next_bytes() = 0;
  virtual void on_bytes_sent(std::size_t count) = 0;
  /// False: more input is not taken now (what is here must be worked off first); the stream is not read.
  virtual bool wants_bytes() const { return true; }
  /// True: the stream is to be closed when all of next_bytes() is sent.
  virtual bool ended() const = 0;
  /// As it is now: control moves from one to another.
  virtual Rank rank() const { return Rank::kAny; }
  /// The stream is gone. The session is destroyed soon after.
  virtual void on_closed(LocalTime now, std::string_view why) = 0;
};

}  // namespace kinebus
