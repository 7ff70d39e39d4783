#pragma once
// Frames of the job link: messages cut out of a stream of bytes and put into one, sans-IO.
//
//   0  magic     "KBJ1"
//   4  length    u32 LE, bytes of the message, at most kMaxMessageBytes
//   8  session   u32 LE, chosen anew by the client for every session; the gateway answers with the same
//   number
//  12  sequence  u32 LE, counts the frames of one direction; 0: the frame that begins the session (hello)
//  16  CRC-32 of the message
//  20  CRC-32 of the 20 bytes before
//  24  message
//
// A reader that meets garbage goes on at the next header that is right. What an earlier session left in a
// pipe (a USB host that came back, a half-sent chunk) carries its old number and is dropped; a gap in the
// sequence is seen, and ends the session in favour of a new one.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "protocol/joblink/byte_queue.hpp"

namespace kinebus::joblink {

inline constexpr std::size_t kFrameHeaderBytes = 24;
inline constexpr std::size_t kMaxMessageBytes = 1U << 20;

struct FrameView {
  std::uint32_t session = 0;
  std::uint32_t sequence = 0;
  std::span<const std::uint8_t> message;
};

/// Appends one frame to `out`. message.size() <= kMaxMessageBytes.
void append_frame(std::string& out, std::uint32_t session, std::uint32_t sequence, std::string_view message);

/// Frames that wait to be sent, in the order in which they were made.
class FrameQueue {
 public:
  /// Room for the next frame's message, `size` <= kMaxMessageBytes; it is a frame after finish(), and nothing
  /// when anything else is called before.
  std::span<std::uint8_t> begin(std::size_t size);
  void finish(std::uint32_t session, std::uint32_t sequence);
  void append(std::uint32_t session, std::uint32_t sequence, std::string_view message);

  std::span<const std::uint8_t> bytes() const { return queue_.bytes(); }
  std::size_t size() const { return queue_.size(); }
  bool empty() const { return queue_.empty(); }
  void sent(std::size_t count) { queue_.drop(count); }
  void clear() { queue_.clear(); }

 private:
  ByteQueue queue_;
  std::span<std::uint8_t> frame_;  ///< between begin() and finish()
};

/// Bytes in, frames out. Memory is bounded by twice the longest frame and one add().
class FrameReader {
 public:
  struct Counters {
    std::uint64_t frames = 0;
    std::uint64_t skipped_bytes = 0;   ///< that were in no frame
    std::uint32_t garbled_frames = 0;  ///< header right, message not
  };

  /// Views of frames are void.
  void add(std::span<const std::uint8_t> bytes);
  /// The next whole frame; its view is valid until the next call of add() or next().
  std::optional<FrameView> next();
  /// Forgets half a frame: the stream was opened anew.
  void clear();
  /// The rest of a half frame does not come: looks for the next header within what is here.
  void give_up();

  /// Bytes that wait for the rest of their frame.
  std::size_t pending() const { return buffer_.size(); }
  const Counters& counters() const { return counters_; }

 private:
  void skip(std::size_t count);

  ByteQueue buffer_;
  Counters counters_;
};

/// Which frames of a stream belong to the session, in order.
class SessionSequence {
 public:
  enum class Verdict : std::uint8_t {
    kNext,    ///< take it
    kBegins,  ///< sequence 0 of another session
    kStale,   ///< of an earlier session: drop it
    kGap,     ///< of this session, but frames before it are missing
  };
  /// From now on only `session` counts; its next frame has the number `next`.
  void begin(std::uint32_t session, std::uint32_t next) {
    session_ = session;
    next_ = next;
  }
  Verdict take(const FrameView& frame);
  std::uint32_t session() const { return session_; }

  /// The number that follows. 0 comes never again.
  static std::uint32_t after(std::uint32_t sequence) { return sequence == 0xFFFF'FFFFU ? 1 : sequence + 1; }

 private:
  std::uint32_t session_ = 0;
  std::uint32_t next_ = 0;
};

}  // namespace kinebus::joblink
