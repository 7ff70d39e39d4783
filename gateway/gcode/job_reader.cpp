#include "gateway/gcode/job_reader.hpp"

#include <cstring>

namespace kinebus::gcode {
namespace {

bool is_comment(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first != std::string_view::npos && text[first] == ';';
}

}  // namespace

Result<void, ParseError> JobReader::line(std::string_view text, CommandBuffer& out) {
  ++line_;
  if (interpreter_.ended()) return {};
  if (const void* nul = std::memchr(text.data(), 0, text.size())) {
    const auto column = static_cast<std::uint32_t>(static_cast<const char*>(nul) - text.data()) + 1;
    return failed_ = Error<ParseError>(
               {line_, column, say("the text holds a NUL byte: this is not a G-code file")});
  }
  if (text.size() > kMaxLine && !is_comment(text))
    return failed_ = Error<ParseError>(
               {line_, static_cast<std::uint32_t>(kMaxLine) + 1, say("the line is longer than 4096 bytes")});
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  auto result = interpreter_.execute(text, line_, out);
  if (!result) failed_ = result;
  return result;
}

Result<void, ParseError> JobReader::read(std::string_view chunk, CommandBuffer& out) {
  if (!failed_) return failed_;
  bytes_ += chunk.size();
  while (!chunk.empty()) {
    const std::size_t end = chunk.find('\n');
    const bool whole = end != std::string_view::npos;
    const std::string_view part = chunk.substr(0, end);
    chunk.remove_prefix(whole ? end + 1 : chunk.size());
    if (whole && carry_.empty()) {
      if (auto result = line(part, out); !result) return result;
      continue;
    }
    if (!long_comment_) {
      carry_.append(part.substr(0, kMaxLine + 1));
      if (carry_.size() > kMaxLine) {
        // Too long to keep: its beginning says whether it may be passed over.
        carry_.resize(kMaxLine + 1);
        long_comment_ = is_comment(carry_);
        if (!long_comment_) return line(carry_, out);
      }
    }
    if (!whole) continue;
    auto result = line(carry_, out);
    carry_.clear();
    long_comment_ = false;
    if (!result) return result;
  }
  return {};
}

Result<void, ParseError> JobReader::finish(CommandBuffer& out) {
  if (!failed_) return failed_;
  if (!carry_.empty()) {
    auto result = line(carry_, out);
    carry_.clear();
    long_comment_ = false;
    if (!result) return result;
  }
  interpreter_.finish(line_, out);
  return {};
}

}  // namespace kinebus::gcode
