#include "gateway/gcode/programs/job_reader.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace kinebus::gcode {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_comment(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first != std::string_view::npos && text[first] == ';';
}

/// Files that are often taken for G-code, by their first bytes.
std::optional<Sentence> not_text(std::string_view begin) {
  struct Kind {
    std::string_view begin;
    const char* words;
  };
  static constexpr std::array<Kind, 5> kKinds = {{
      {"GCDE", phrase("this is binary G-code (.bgcode): have the slicer write it as text")},
      {"PK\x03\x04", phrase("this is a ZIP archive (3MF or similar): unpack the G-code in it first")},
      {"\x1F\x8B", phrase("this is a gzip archive: unpack it first")},
      {"\xFF\xFE", phrase("this text is UTF-16: save it as UTF-8")},
      {"\xFE\xFF", phrase("this text is UTF-16: save it as UTF-8")},
  }};
  for (const Kind& kind : kKinds)
    if (begin.starts_with(kind.begin)) return say(kind.words);
  return std::nullopt;
}

}  // namespace

Result<void, ParseError> JobReader::refuse(ParseError error) {
  ++refused_;
  if (skips_) {
    if (std::find(reasons_.begin(), reasons_.end(), error.message.english()) != reasons_.end()) {
      ++untold_;
      return {};
    }
  }
  if (reasons_.size() < kReasons) reasons_.push_back(error.message.english());
  return failed_ = Error<ParseError>(std::move(error));
}

Result<void, ParseError> JobReader::line(std::string_view text, CommandBuffer& out) {
  if (program_.busy()) [[unlikely]] {
    if (auto result = run_recorded(kWithoutEnd, out); !result) return result;
  }
  ++line_;
  if (interpreter_.ended() || no_text_) return {};
  const bool too_long = text.size() > kMaxLine && !is_comment(text);
  if (line_ == 1) {
    if (auto words = not_text(text)) {
      no_text_ = true;
      return refuse({1, 1, std::move(*words)});
    }
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  }
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    const auto column = static_cast<std::uint32_t>(nul) + 1;
    return refuse({line_, column, say("the text holds a NUL byte: this is not a G-code file")});
  }
  if (too_long)
    return refuse(
        {line_, static_cast<std::uint32_t>(kMaxLine) + 1, say("the line is longer than 4096 bytes")});
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  if (in_header_) [[unlikely]] {
    // Comments with which the text begins, pictures among them, and those of the first lines.
    constexpr std::uint32_t kHeaderLines = 40;
    const bool is_comment_line = !text.empty() && (text.front() == ';' || text.front() == '(');
    if (is_comment_line) {
      if (auto read = interpreter_.read_header(text, line_); !read) return refuse(std::move(read.error()));
    } else if (line_ > kHeaderLines && !text.empty()) {
      in_header_ = false;
    }
  }
  if (auto result = program_.line(text, line_, out); !result) return refuse(std::move(result.error()));
  if (program_.busy()) [[unlikely]]
    return run_recorded(steps_a_call_, out);
  return {};
}

Result<void, ParseError> JobReader::run_recorded(std::uint32_t steps, CommandBuffer& out) {
  for (; steps > 0 && program_.busy(); --steps)
    if (auto result = program_.step(out); !result) return refuse(std::move(result.error()));
  return {};
}

Result<void, ParseError> JobReader::end_carried_line(CommandBuffer& out) {
  auto result = line(carry_, out);
  carry_.clear();
  long_comment_ = false;
  return result;
}

/// Looks for the end of the text's first line. A CR is one when something else than LF follows; blanks of CRs
/// before an LF are not.
void JobReader::find_ending(std::string_view chunk) {
  if (!carry_.empty() && carry_.back() == '\r') {
    const std::size_t next = chunk.find_first_not_of('\r');
    if (next != std::string_view::npos) ending_ = chunk[next] == '\n' ? Ending::kFeed : Ending::kReturn;
    return;
  }
  const std::size_t end = chunk.find_first_of("\r\n");
  if (end == std::string_view::npos) return;
  const std::size_t next = chunk.find_first_not_of('\r', end);
  if (next != std::string_view::npos) ending_ = chunk[next] == '\n' ? Ending::kFeed : Ending::kReturn;
}

Result<void, ParseError> JobReader::read(std::string_view chunk, CommandBuffer& out) {
  taken_ = 0;
  if (!failed_) return failed_;
  if (program_.busy()) [[unlikely]] {
    if (auto result = run_recorded(steps_a_call_, out); !result || program_.busy()) return result;
  }
  const char* const begin = chunk.data();
  if (ending_ == Ending::kUnknown) {
    find_ending(chunk);
    if (ending_ == Ending::kReturn && !carry_.empty() && carry_.back() == '\r') {
      // The CRs at the end of what is carried turn out to end lines; all but the first are empty ones.
      const std::size_t text = carry_.find_last_not_of('\r') + 1;
      const std::size_t empty = carry_.size() - text - 1;
      carry_.resize(text);
      static_cast<void>(end_carried_line(out));
      for (std::size_t i = 0; i < empty; ++i) static_cast<void>(line({}, out));
      after_return_ = true;
      if (!failed_) return failed_;
      if (program_.busy()) return {};
    }
  }
  const bool returns = ending_ == Ending::kReturn;
  while (!chunk.empty()) {
    if (std::exchange(after_return_, false) && chunk.front() == '\n') {
      chunk.remove_prefix(1);
      continue;
    }
    const std::size_t end = returns ? chunk.find_first_of("\r\n") : chunk.find('\n');
    const bool whole = end != std::string_view::npos;
    const std::string_view part = chunk.substr(0, end);
    after_return_ = returns && whole && chunk[end] == '\r';
    chunk.remove_prefix(whole ? end + 1 : chunk.size());
    const auto taken = static_cast<std::size_t>(chunk.data() - begin);
    bytes_ += taken - taken_;
    taken_ = taken;
    if (rest_of_line_) {
      rest_of_line_ = !whole;
      continue;
    }
    if (whole && carry_.empty()) {
      if (auto result = line(part, out); !result || program_.busy()) return result;
      continue;
    }
    if (!long_comment_) {
      carry_.append(part.substr(0, kMaxLine + 1));
      if (carry_.size() > kMaxLine) {
        // Too long to keep: its beginning says whether it may be passed over.
        carry_.resize(kMaxLine + 1);
        long_comment_ = is_comment(carry_);
        if (!long_comment_) {
          rest_of_line_ = !whole;
          if (auto result = end_carried_line(out); !result || program_.busy()) return result;
          continue;
        }
      }
    }
    if (!whole) continue;
    if (auto result = end_carried_line(out); !result || program_.busy()) return result;
  }
  const auto taken = static_cast<std::size_t>(chunk.data() - begin);
  bytes_ += taken - taken_;
  taken_ = taken;
  return {};
}

Result<void, ParseError> JobReader::finish(CommandBuffer& out) {
  if (!failed_) return failed_;
  if (program_.busy()) {
    if (auto result = run_recorded(steps_a_call_, out); !result || program_.busy()) return result;
  }
  if (!carry_.empty())
    if (auto result = end_carried_line(out); !result || program_.busy()) return result;
  if (!interpreter_.ended())
    if (auto result = program_.finish(); !result) {
      if (auto refused = refuse(std::move(result.error())); !refused) return refused;
    }
  if (program_.busy()) {
    if (auto result = run_recorded(steps_a_call_, out); !result || program_.busy()) return result;
  }
  if (interpreter_.compensates() || interpreter_.in_nurbs()) {
    // The text's end is G40's place, and may be refused as that; a NURBS without end is.
    if (auto ended = interpreter_.execute("G40", line_, out); !ended) {
      if (auto refused = refuse(std::move(ended.error())); !refused) return refused;
    }
  }
  interpreter_.finish(line_, out);
  return {};
}

}  // namespace kinebus::gcode
