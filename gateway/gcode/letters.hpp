#pragma once
// G-code's words are the same in upper and lower case, whatever the locale says.

#include <string>
#include <string_view>

namespace kinebus::gcode {

inline char in_lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}
inline std::string in_lower_case(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = in_lower_case(c);
  return small;
}

inline std::string in_upper_case(std::string_view text) {
  std::string large(text);
  for (char& c : large)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - ('a' - 'A'));
  return large;
}

}  // namespace kinebus::gcode
