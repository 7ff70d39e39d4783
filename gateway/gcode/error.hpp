#pragma once
// What a G-code line can be refused with.

#include <cstdint>
#include <string>

#include "gateway/sentence.hpp"

namespace kinebus::gcode {

/// A line that is refused: nothing of it was carried out.
struct ParseError {
  std::uint32_t line = 0;    ///< 1-based, as given by the caller
  std::uint32_t column = 0;  ///< 1-based byte of the line
  Sentence message;          ///< the rule and what was expected: "G2 needs I and J, or R"
};
/// "12:7: G2 needs I and J, or R"
inline std::string to_string(const ParseError& error) {
  return std::to_string(error.line) + ":" + std::to_string(error.column) + ": " + error.message;
}

/// Something accepted that has no effect here; told once for each code.
struct Note {
  std::uint32_t line = 0;
  Sentence text;
};

}  // namespace kinebus::gcode
