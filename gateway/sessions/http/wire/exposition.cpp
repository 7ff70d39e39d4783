#include "gateway/sessions/http/wire/exposition.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace kinebus::http {
namespace {

/// A label's text: backslash, quotation mark and line end are written otherwise.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n') {
      out += "\\n";
      continue;
    }
    if (c == '\\' || c == '"') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace

Exposition& Exposition::family(std::string_view name, std::string_view type, std::string_view help) {
  name_ = name;
  for (const std::string_view piece : {std::string_view("# HELP "), name, std::string_view(" "), help,
                                       std::string_view("\n# TYPE "), name, std::string_view(" "), type})
    text_ += piece;
  text_ += '\n';
  return *this;
}

Exposition& Exposition::sample(double value, Labels labels) {
  if (!std::isfinite(value)) return *this;
  text_ += name_;
  char before = '{';
  for (const auto& [label, text] : labels) {
    text_ += before;
    text_ += label;
    text_ += "=\"" + escaped(text) + '"';
    before = ',';
  }
  if (labels.size() > 0) text_ += '}';
  std::array<char, 32> digits{};
  const std::to_chars_result end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text_ += ' ';
  text_.append(digits.data(), static_cast<std::size_t>(end.ptr - digits.data()));
  text_ += '\n';
  return *this;
}

}  // namespace kinebus::http
