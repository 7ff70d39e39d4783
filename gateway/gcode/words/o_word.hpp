#pragma once
// O words: what a line with one says, before anything of it is carried out.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/gcode/words/expression.hpp"

namespace kinebus::gcode {

enum class OKind : std::uint8_t {
  kNone,     ///< a line without an O word
  kProgram,  ///< O1234 alone: the beginning of a numbered program
  kSub,
  kEndsub,
  kReturn,
  kCall,
  kIf,
  kElseif,
  kElse,
  kEndif,
  kWhile,  ///< also the end of a do
  kEndwhile,
  kDo,
  kDoWhile,  ///< the while that ends a do
  kRepeat,
  kEndrepeat,
  kBreak,
  kContinue,
  kMeta,  ///< var, global, set, echo, abort
};

struct OWord {
  OKind kind = OKind::kNone;
  /// "100", or "<name>" in lower case without blanks; empty: computed (o[#1 + 2] call), its text stands from
  /// `label_at` on.
  std::string label;
  std::size_t label_at = 0;
  std::size_t rest_at = 0;  ///< what follows the keyword
  std::uint32_t column = 1;
  bool deleted = false;  ///< the line begins with /
  bool meta = false;     ///< RepRapFirmware's, or the end of what it has indented
};

/// Whether the line may hold an O word or a call; false for the lines that jobs are made of. Costs a glance.
inline bool may_be_o_word(std::string_view line) {
  std::size_t at = 0;
  while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
  if (at == line.size()) return false;
  const char c = line[at];
  return c == 'o' || c == 'O' || c == 'n' || c == 'N' || c == '/';
}

/// Reads the O word at the line's beginning (behind / and N). False with `error`: there is one, and it is
/// wrong.
bool read_o_word(std::string_view line, OWord& word, SyntaxError& error);

/// "while"; empty for lines without a keyword.
std::string_view o_keyword(OKind kind);
/// "o100", "o<name>"
std::string o_name(std::string_view label);

}  // namespace kinebus::gcode
