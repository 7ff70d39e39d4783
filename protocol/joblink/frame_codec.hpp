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
// A reader that meets garbage goes on at the next header that is right; however headers are nested, it checks
// a bounded number of bytes for each byte that comes. What an earlier session left in a
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

/// Appends one frame to `out`. False: the message is longer than kMaxMessageBytes, nothing is appended.
bool append_frame(std::string& out, std::uint32_t session, std::uint32_t sequence, std::string_view message);

/// Frames that wait to be sent, in the order in which they were made.
class FrameQueue {
 public:
  /// Room for the next frame's message; it is a frame after finish(), and nothing when anything else is
  /// called before. nullopt: `size` is more than kMaxMessageBytes, no frame can carry it.
  std::optional<std::span<std::uint8_t>> begin(std::size_t size);
  void finish(std::uint32_t session, std::uint32_t sequence);
  /// False: longer than kMaxMessageBytes, nothing is appended.
  bool append(std::uint32_t session, std::uint32_t sequence, std::string_view message);

  std::span<const std::uint8_t> bytes() const { return queue_.bytes(); }
  std::size_t size() const { return queue_.size(); }
  bool empty() const { return queue_.empty(); }
  void sent(std::size_t count) { queue_.drop(count); }
  void clear() { queue_.clear(); }

 private:
  ByteQueue queue_;
  std::span<std::uint8_t> frame_;  ///< between begin() and finish()
};

/// Bytes in, frames out. Memory is bounded by twice the longest frame and one add(). Cost: of each byte that
/// is in a frame one CRC; the CRCs that turn out wrong cover at most kMaxDebt bytes and seven for each that
/// was skipped.
class FrameReader {
 public:
  /// Two frames whose bytes were lost in a row, of the longest kind.
  static constexpr std::size_t kMaxDebt = 2 * kMaxMessageBytes;
  /// Messages that cost little more than their header, whatever went wrong before: a hello among them.
  static constexpr std::size_t kAlwaysChecked = 128;

  struct Counters {
    std::uint64_t frames = 0;
    std::uint64_t skipped_bytes = 0;   ///< that were in no frame
    std::uint32_t garbled_frames = 0;  ///< header right, message not
    std::uint64_t checked_bytes = 0;   ///< of messages whose CRC was computed
  };

  /// A header that states a longer message is none. At first kMaxMessageBytes.
  void limit(std::size_t message_bytes) { limit_ = message_bytes; }

  /// Views of frames are void.
  void add(std::span<const std::uint8_t> bytes);
  /// The next whole frame; its view is valid until the next call of add() or next().
  std::optional<FrameView> next();
  /// Shows `see` the whole frames that wait, up to the first that is not whole or not right, without their
  /// CRC checked: next() decides what they are. Cost: 20 bytes of CRC for each.
  template <typename See>
  void look_ahead(const See& see) const {
    for (auto rest = buffer_.bytes();;) {
      const auto frame = whole_frame(rest);
      if (!frame) return;
      see(*frame);
      rest = rest.subspan(kFrameHeaderBytes + frame->message.size());
    }
  }
  /// Forgets half a frame: the stream was opened anew.
  void clear();
  /// The rest of half frames does not come: none that begins within what is here is waited for any more.
  void give_up() { given_up_ = buffer_.size(); }

  /// Bytes that wait for the rest of their frame.
  std::size_t pending() const { return buffer_.size(); }
  const Counters& counters() const { return counters_; }

 private:
  std::optional<FrameView> whole_frame(std::span<const std::uint8_t> bytes) const;
  void skip(std::size_t count);
  void taken(std::size_t count);

  ByteQueue buffer_;
  Counters counters_;
  std::size_t limit_ = kMaxMessageBytes;
  std::size_t debt_ = 0;      ///< bytes checked in vain, less those skipped since
  std::size_t given_up_ = 0;  ///< at the front: half frames that begin here are none
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
