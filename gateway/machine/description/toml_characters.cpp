#include "gateway/machine/description/toml_characters.hpp"

namespace kinebus {

std::optional<std::uint32_t> misplaced_character(std::string_view toml) {
  std::uint32_t line = 1;
  // The delimiter of the string we are in: one or three quotes; empty outside.
  std::string_view string;
  bool comment = false;
  // A byte order mark may lead the text.
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  for (std::size_t i = toml.starts_with(kMark) ? kMark.size() : 0; i < toml.size(); ++i) {
    const char c = toml[i];
    if (c == '\n') {
      ++line;
      comment = false;
      // A string of one quote ends with its line at the latest: what follows is an error that the parser
      // finds.
      if (string.size() == 1) string = {};
    } else if (comment) {
      continue;
    } else if (!string.empty()) {
      if (c == '\\' && string[0] == '"' && i + 1 < toml.size() && toml[i + 1] != '\n') {
        ++i;
      } else if (toml.substr(i).starts_with(string)) {
        i += string.size() - 1;
        // Up to two quotes may stand before the closing three.
        while (string.size() == 3 && i + 1 < toml.size() && toml[i + 1] == c) ++i;
        string = {};
      }
    } else if (c == '#') {
      comment = true;
    } else if (c == '"' || c == '\'') {
      const std::string_view rest = toml.substr(i);
      const std::string_view triple = c == '"' ? "\"\"\"" : "'''";
      string = rest.starts_with(triple) ? triple : triple.substr(0, 1);
      i += string.size() - 1;
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      return line;
    }
  }
  return std::nullopt;
}

}  // namespace kinebus
