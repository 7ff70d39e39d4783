#pragma once
// Frames of the WebSocket protocol (RFC 6455), sans-IO: messages out of a client's bytes, and frames for the
// answer. No extensions. Own code: Boost.Beast's framing lives inside its stream over Asio's sockets.
//
//   take(bytes) -> one step and how many bytes it took, as Reader (http_reader.hpp)

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace kinebus::http {

/// RFC 6455, 7.4.1
enum class CloseCode : std::uint16_t {
  kNormal = 1000,
  kGoingAway = 1001,
  kProtocol = 1002,
  kUnsupported = 1003,
  kNone = 1005,  ///< the client said none; never sent
  kNoUtf8 = 1007,
  kPolicy = 1008,
  kTooBig = 1009,
};

enum class Opcode : std::uint8_t { kMore = 0, kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10 };

class FrameReader {
 public:
  /// Of a message, all its frames together.
  static constexpr std::size_t kMaxMessage = 64U << 10;
  static constexpr std::size_t kMaxControl = 125;
  enum class Step : std::uint8_t {
    kMore,
    kText,  ///< payload() is a message, valid UTF-8
    kPing,  ///< payload() is what the pong must say
    kPong,
    kClose,  ///< code(): what the client said
    kBad,    ///< code(), why(); nothing can be read after it
  };
  struct Taken {
    Step step{};
    std::size_t count = 0;
  };

  Taken take(std::string_view bytes);
  /// Of the last step, until the next call.
  std::string_view payload() const { return told_; }
  CloseCode code() const { return code_; }
  std::string_view why() const { return why_; }
  std::size_t held_bytes() const { return message_.size() + control_.size(); }

 private:
  /// False: more bytes are needed, or it is bad.
  bool take_head(std::string_view bytes, std::size_t& at);
  bool check_head();
  Taken end_frame(std::size_t at);
  Taken end_close(std::size_t at);
  Step bad(CloseCode code, std::string_view why);

  std::string head_;  ///< as far as it has come
  std::string message_, control_, told_;
  std::uint64_t length_ = 0, taken_ = 0;  ///< of the frame's payload
  Opcode opcode_{};
  bool in_frame_ = false, final_ = false, in_message_ = false, is_bad_ = false;
  std::uint8_t mask_[4]{};
  CloseCode code_ = CloseCode::kNone;
  std::string_view why_;
};

/// One whole frame of a server, which masks nothing.
std::string frame(Opcode opcode, std::string_view payload);
std::string close_frame(CloseCode code, std::string_view why);
/// Sec-WebSocket-Accept of a Sec-WebSocket-Key; empty: the key is none.
std::string accept_of(std::string_view key);

}  // namespace kinebus::http
