#include "gateway/sessions/http/wire/websocket.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus::http {
namespace {

constexpr std::uint8_t kFinal = 0x80, kReserved = 0x70, kOpcode = 0x0F, kMasked = 0x80, kLength = 0x7F;

std::uint8_t byte_at(std::string_view text, std::size_t at) {
  return static_cast<std::uint8_t>(text[at]);
}

/// 7.4.1 and 7.4.2: what may be said in a close frame.
bool may_be_said(unsigned code) {
  return (code >= 1000 && code <= 1014 && code != 1004 && code != 1005 && code != 1006) ||
         (code >= 3000 && code <= 4999);
}

}  // namespace

FrameReader::Step FrameReader::bad(CloseCode code, std::string_view why) {
  is_bad_ = true;
  code_ = code;
  why_ = why;
  message_.clear();
  control_.clear();
  return Step::kBad;
}

bool FrameReader::take_head(std::string_view bytes, std::size_t& at) {
  const auto needed = [this]() -> std::size_t {
    if (head_.size() < 2) return 2;
    const std::uint8_t length = byte_at(head_, 1) & kLength;
    return 2U + (length == 127 ? 8U : length == 126 ? 2U : 0U) + 4U;
  };
  while (head_.size() < needed()) {
    if (at == bytes.size()) return false;
    head_ += bytes[at++];
    // What is wrong with these two is told before more is waited for.
    if (head_.size() == 2 && !check_head()) return false;
  }
  const std::uint8_t small = byte_at(head_, 1) & kLength;
  length_ = small;
  if (small >= 126) {
    length_ = 0;
    for (std::size_t i = 2; i < head_.size() - 4; ++i) length_ = length_ << 8U | byte_at(head_, i);
    if (length_ < 126 || (small == 127 && length_ <= 0xFFFF) || length_ >> 63U != 0) {
      bad(CloseCode::kProtocol, "the length of a frame is written as shortly as can be");
      return false;
    }
  }
  if (length_ > kMaxMessage || (opcode_ < Opcode::kClose && message_.size() + length_ > kMaxMessage)) {
    bad(CloseCode::kTooBig, "a message has at most 64 KiB");
    return false;
  }
  for (std::size_t i = 0; i < 4; ++i) mask_[i] = byte_at(head_, head_.size() - 4 + i);
  head_.clear();
  in_frame_ = true;
  taken_ = 0;
  if (opcode_ >= Opcode::kClose) control_.clear();
  return true;
}

bool FrameReader::check_head() {
  const std::uint8_t first = byte_at(head_, 0), second = byte_at(head_, 1);
  const auto no = [this](CloseCode code, std::string_view why) {
    bad(code, why);
    return false;
  };
  opcode_ = static_cast<Opcode>(first & kOpcode);
  final_ = (first & kFinal) != 0;
  if ((first & kReserved) != 0) return no(CloseCode::kProtocol, "no extension was agreed on");
  if ((second & kMasked) == 0) return no(CloseCode::kProtocol, "a client masks its frames");
  switch (opcode_) {
    case Opcode::kClose:
    case Opcode::kPing:
    case Opcode::kPong:
      if (!final_ || (second & kLength) > kMaxControl)
        return no(CloseCode::kProtocol, "a control frame is whole and has at most 125 bytes");
      return true;
    case Opcode::kBinary:
      return no(CloseCode::kUnsupported, "messages are text");
    case Opcode::kText:
      if (in_message_) return no(CloseCode::kProtocol, "a message begins within another");
      return true;
    case Opcode::kMore:
      if (!in_message_) return no(CloseCode::kProtocol, "a message goes on that did not begin");
      return true;
  }
  return no(CloseCode::kProtocol, "no frame has this opcode");
}

FrameReader::Taken FrameReader::take(std::string_view bytes) {
  if (is_bad_) return {Step::kBad, 0};
  std::size_t at = 0;
  if (!in_frame_ && !take_head(bytes, at)) return {is_bad_ ? Step::kBad : Step::kMore, at};
  std::string& into = opcode_ >= Opcode::kClose ? control_ : message_;
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(length_ - taken_, bytes.size() - at));
  for (std::size_t i = 0; i < count; ++i)
    into += static_cast<char>(byte_at(bytes, at + i) ^ mask_[(taken_ + i) % 4]);
  taken_ += count;
  at += count;
  if (taken_ < length_) return {Step::kMore, at};
  return end_frame(at);
}

FrameReader::Taken FrameReader::end_frame(std::size_t at) {
  in_frame_ = false;
  if (opcode_ == Opcode::kClose) return end_close(at);
  if (opcode_ >= Opcode::kClose) {
    told_ = control_;
    return {opcode_ == Opcode::kPing ? Step::kPing : Step::kPong, at};
  }
  in_message_ = !final_;
  if (in_message_) {
    told_.clear();
    // A front of it that cannot become UTF-8 any more is seen at its end.
    return {Step::kMore, at};
  }
  told_ = std::move(message_);
  message_.clear();
  if (!is_utf8(told_)) return {bad(CloseCode::kNoUtf8, "a message of text is UTF-8"), at};
  return {Step::kText, at};
}

FrameReader::Taken FrameReader::end_close(std::size_t at) {
  if (control_.size() == 1) return {bad(CloseCode::kProtocol, "a close code has two bytes"), at};
  code_ = CloseCode::kNone;
  if (control_.size() >= 2) {
    const unsigned code = static_cast<unsigned>(byte_at(control_, 0) << 8U) | byte_at(control_, 1);
    if (!may_be_said(code)) return {bad(CloseCode::kProtocol, "no close has this code"), at};
    if (!is_utf8(std::string_view(control_).substr(2)))
      return {bad(CloseCode::kNoUtf8, "the reason of a close is UTF-8"), at};
    code_ = static_cast<CloseCode>(code);
  }
  is_bad_ = true;  // Nothing follows.
  return {Step::kClose, at};
}

std::string frame(Opcode opcode, std::string_view payload) {
  std::string bytes(1, static_cast<char>(kFinal | static_cast<std::uint8_t>(opcode)));
  const std::uint64_t length = payload.size();
  const auto put = [&](int count) {
    for (int i = count - 1; i >= 0; --i) bytes += static_cast<char>(length >> (8 * static_cast<unsigned>(i)));
  };
  if (length < 126) {
    put(1);
  } else if (length <= 0xFFFF) {
    bytes += static_cast<char>(126);
    put(2);
  } else {
    bytes += static_cast<char>(127);
    put(8);
  }
  return bytes.append(payload);
}

std::string close_frame(CloseCode code, std::string_view why) {
  const auto number = static_cast<unsigned>(code);
  std::string payload{static_cast<char>(number >> 8U), static_cast<char>(number & 0xFFU)};
  return frame(Opcode::kClose, payload.append(cut_text(why, FrameReader::kMaxControl - 2)));
}

std::string accept_of(std::string_view key) {
  static constexpr std::string_view kGuid = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
  static constexpr std::size_t kKeyLength = 24;  // 16 bytes in base64
  if (key.size() != kKeyLength || !key.ends_with("==")) return {};
  std::array<unsigned char, 20> hash{};
  unsigned length = 0;
  const std::string text = std::string(key).append(kGuid);
  EVP_Digest(text.data(), text.size(), hash.data(), &length, EVP_sha1(), nullptr);
  std::array<unsigned char, 32> base64{};
  const int count = EVP_EncodeBlock(base64.data(), hash.data(), static_cast<int>(length));
  return {reinterpret_cast<const char*>(base64.data()), static_cast<std::size_t>(count)};
}

}  // namespace kinebus::http
