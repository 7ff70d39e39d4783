#pragma once
// One line of G-code, read: words with values, codes by modal group, assignments, texts. Syntax and modal
// groups are checked here; what the words mean is the interpreter's matter.

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "gateway/gcode/words/codes.hpp"
#include "gateway/gcode/words/expression.hpp"
#include "gateway/gcode/words/state.hpp"

namespace kinebus::gcode {

/// A G code in tenths or an M number, with its place.
struct Code {
  int number = 0;
  std::uint32_t column = 0;
};

struct Assignment {
  ParameterRef target;
  double value = 0;
  std::uint32_t column = 0;
};

/// Reused from line to line. Only clear() resets it: values of words that are not present are left over.
struct Block {
  static constexpr int kMaxMCodes = 8;
  static constexpr std::size_t kMaxAssignments = 32;

  std::uint32_t present = 0;  ///< bit per letter; G, M and a leading N aside
  std::uint32_t bare = 0;     ///< letters without a number (G28 X)
  std::array<double, 26> value{};
  std::array<std::uint32_t, 26> column{};

  /// @ and ^: distance from the zero point of X and Y, and angle in degrees.
  std::optional<double> polar_radius, polar_angle;
  std::uint32_t polar_column = 0;

  std::uint32_t groups = 0;  ///< bit per GGroup
  std::array<Code, kGGroups> g{};
  int m_count = 0;
  std::array<Code, kMaxMCodes> m{};
  int harmless_g = -1;  ///< a G code without effect, in tenths

  bool has_line_number = false;
  bool has_checksum = false;
  bool a_taken = false;  ///< an A was read as E
  bool deleted = false;  ///< begins with /
  bool percent = false;  ///< a % line
  std::int64_t line_number = 0;

  std::string_view command;  ///< the word that begins the line (START_PRINT); text: what follows it
  std::uint32_t command_column = 0;

  int text_of_m = -1;     ///< the M code that took the rest of the line as its text, which may be empty
  std::string_view text;  ///< trimmed
  std::uint32_t text_column = 0;
  std::vector<std::string_view> messages;  ///< (MSG, ...)
  std::vector<Assignment> assignments;

  static constexpr std::size_t index(char letter) { return static_cast<std::size_t>(letter - 'A'); }
  static constexpr std::uint32_t bit(char letter) { return 1U << index(letter); }
  bool has(char letter) const { return (present & bit(letter)) != 0; }
  bool is_bare(char letter) const { return (bare & bit(letter)) != 0; }
  double operator[](char letter) const { return value[index(letter)]; }
  std::uint32_t column_of(char letter) const { return column[index(letter)]; }
  bool has(GGroup group) const { return (groups >> static_cast<unsigned>(group) & 1U) != 0; }
  Code code(GGroup group) const { return g[static_cast<std::size_t>(group)]; }
  bool has_m(int number) const;
  /// Nothing but motion codes and words with values: the lines that jobs are made of.
  bool is_plain() const { return plain; }

  void clear();
  bool plain = true;  ///< set to false by whatever is_plain() excludes
};

/// Reads one line (no line end in it). False with `error` filled in. Numbers of words are limited to 10^9, G
/// codes to one decimal place. `state` gives the values of parameters; assignments are only noted.
bool read_block(std::string_view line, const State& state, Block& block, SyntaxError& error);

}  // namespace kinebus::gcode
