#include "gateway/sessions/http/wire/multipart.hpp"

#include <algorithm>
#include <utility>

#include "gateway/sessions/http/wire/http_reader.hpp"
#include "gateway/sessions/http/wire/target.hpp"

namespace kinebus::http {
namespace {

/// A text before the first boundary is allowed, and nobody sends one.
constexpr std::size_t kMaxPreamble = 1024;
/// RFC 2046.
constexpr std::size_t kMaxBoundary = 70;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Takes "; name=value" or "; name="value"" from the front. False: there is none, or it is malformed
/// (`text` is then not empty).
bool take_parameter(std::string_view& text, std::string& name, std::string& value) {
  text = trimmed(text);
  if (text.empty() || text.front() != ';') return false;
  std::string_view rest = trimmed(text.substr(1));
  const std::size_t equals = rest.find('=');
  if (equals == std::string_view::npos) return false;
  name = trimmed(rest.substr(0, equals));
  rest = trimmed(rest.substr(equals + 1));
  value.clear();
  if (rest.empty() || rest.front() != '"') {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    value = trimmed(rest.substr(0, end));
    text = rest.substr(end);
    return true;
  }
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i] == '"') {
      text = rest.substr(i + 1);
      return true;
    }
    // Programs for Windows send paths with lone backslashes: only what must be escaped is.
    if (rest[i] == '\\' && i + 1 < rest.size() && (rest[i + 1] == '"' || rest[i + 1] == '\\')) ++i;
    value += rest[i];
  }
  return false;
}

/// filename*=UTF-8''a%20b (RFC 5987).
std::optional<std::string> extended(std::string_view value) {
  const std::size_t quote = value.find('\'');
  const std::size_t second = quote == std::string_view::npos ? quote : value.find('\'', quote + 1);
  if (second == std::string_view::npos || !same_word(value.substr(0, quote), "UTF-8")) return std::nullopt;
  return percent_decoded(value.substr(second + 1));
}

}  // namespace

std::optional<std::string> boundary_of(std::string_view content_type) {
  const std::size_t end = std::min(content_type.find(';'), content_type.size());
  if (!same_word(trimmed(content_type.substr(0, end)), "multipart/form-data")) return std::nullopt;
  std::string_view rest = content_type.substr(end);
  std::string name, value;
  while (take_parameter(rest, name, value))
    if (same_word(name, "boundary") && !value.empty() && value.size() <= kMaxBoundary) return value;
  return std::nullopt;
}

// The first boundary has no line break before it when nothing else has.
Multipart::Multipart(std::string_view boundary)
    : delimiter_("\r\n--" + std::string(boundary)), buffer_("\r\n") {}

void Multipart::add(std::string_view bytes) {
  buffer_.erase(0, spent_);
  spent_ = 0;
  if (state_ != State::kEnded && state_ != State::kBad) buffer_ += bytes;
}

Multipart::Step Multipart::bad(const char* why) {
  state_ = State::kBad;
  why_ = why;
  buffer_.clear();
  return Step::kBad;
}

Multipart::Step Multipart::next() {
  buffer_.erase(0, spent_);
  spent_ = 0;
  switch (state_) {
    case State::kPreamble: {
      const std::size_t at = buffer_.find(delimiter_);
      if (at == std::string::npos)
        return buffer_.size() > kMaxPreamble ? bad("the form does not begin with its boundary") : Step::kMore;
      buffer_.erase(0, at + delimiter_.size());
      state_ = State::kAfterBoundary;
      return after_boundary();
    }
    case State::kAfterBoundary:
      return after_boundary();
    case State::kHead:
      return head();
    case State::kData:
      return piece();
    case State::kEnded:
      buffer_.clear();
      return Step::kEnd;
    case State::kBad:
      return Step::kBad;
  }
  return Step::kBad;
}

Multipart::Step Multipart::after_boundary() {
  if (buffer_.size() < 2) return Step::kMore;
  if (buffer_.starts_with("--")) {
    state_ = State::kEnded;
    buffer_.clear();
    return Step::kEnd;
  }
  if (!buffer_.starts_with("\r\n")) return bad("a line with a boundary holds something else, too");
  if (++parts_ > kMaxParts) return bad("a form has at most 32 parts");
  state_ = State::kHead;
  return head();
}

/// The buffer begins with the line break that ends the boundary's line.
Multipart::Step Multipart::head() {
  const std::size_t end = buffer_.find("\r\n\r\n");
  if (end > kMaxPartHead)  // or none
    return std::min(end, buffer_.size()) > kMaxPartHead ? bad("the head of a part has at most 4 KiB")
                                                        : Step::kMore;
  const std::string lines = buffer_.substr(0, end);
  buffer_.erase(0, end + 4);
  if (const char* wrong = read_head(lines); wrong != nullptr) return bad(wrong);
  state_ = State::kData;
  return Step::kPart;
}

/// nullptr: fine. Each line begins with the line break before it.
const char* Multipart::read_head(std::string_view lines) {
  name_.clear();
  file_name_.reset();
  bool named = false;
  while (!lines.empty()) {
    lines.remove_prefix(2);
    const std::size_t end = std::min(lines.find("\r\n"), lines.size());
    const std::string_view line = lines.substr(0, end);
    lines.remove_prefix(end);
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) return "a line of a part's head has no colon";
    if (!same_word(trimmed(line.substr(0, colon)), "Content-Disposition")) continue;
    std::string_view rest = line.substr(colon + 1);
    const std::size_t kind = std::min(rest.find(';'), rest.size());
    if (!same_word(trimmed(rest.substr(0, kind)), "form-data")) break;
    rest.remove_prefix(kind);
    std::string parameter, value;
    std::optional<std::string> in_utf8;
    while (take_parameter(rest, parameter, value)) {
      if (same_word(parameter, "name")) {
        name_ = value;
        named = true;
      } else if (same_word(parameter, "filename")) {
        file_name_ = value;
      } else if (same_word(parameter, "filename*")) {
        in_utf8 = extended(value);
      }
    }
    if (!trimmed(rest).empty()) return "Content-Disposition of a part cannot be read";
    if (in_utf8) file_name_ = std::move(in_utf8);
  }
  if (!named) return "a part of the form has no name";
  return nullptr;
}

Multipart::Step Multipart::piece() {
  const std::size_t at = buffer_.find(delimiter_);
  if (at == 0) {
    buffer_.erase(0, delimiter_.size());
    state_ = State::kAfterBoundary;
    return Step::kPartEnd;
  }
  if (at != std::string::npos) {
    spent_ = at;
    return Step::kData;
  }
  // What may be the front of a boundary waits.
  if (buffer_.size() < delimiter_.size()) return Step::kMore;
  spent_ = buffer_.size() - (delimiter_.size() - 1);
  return Step::kData;
}

}  // namespace kinebus::http
