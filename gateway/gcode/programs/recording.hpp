#pragma once
// The lines of a text that may be needed again, and how their O words are nested.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "gateway/gcode/error.hpp"
#include "gateway/gcode/words/o_word.hpp"
#include "gateway/result.hpp"

namespace kinebus::gcode {

/// Lines are named by their index. What is defined (subroutines, macros) is kept; loops and conditions are
/// dropped when they are done. Bounded in memory and depth.
class Recording {
 public:
  static constexpr std::size_t kMaxText = 16U << 20;  ///< bytes
  static constexpr std::size_t kMaxLines = 1'000'000;
  static constexpr std::size_t kMaxNested = 100;  ///< blocks within blocks
  static constexpr std::uint32_t kNowhere = 0xFFFFFFFF;

  struct Line {
    std::uint32_t number = 0;  ///< in its text, from 1
    std::uint32_t begin = 0, size = 0;
    OKind kind = OKind::kNone;
    std::uint32_t rest_at = 0;  ///< of the line: behind the keyword
    /// if, elseif: the next branch. while, do, repeat: their end. Ends: their begin.
    std::uint32_t next = kNowhere;
    std::uint32_t end = kNowhere;  ///< branches: endif. break, continue: the loop's begin
    std::string label;             ///< of lines with an O word
    bool meta = false;             ///< RepRapFirmware's
  };
  /// Lines [begin, end).
  struct Range {
    std::uint32_t begin = 0, end = 0;
    std::uint32_t number = 0;  ///< of the line where it is defined
  };

  /// One line more. An error (too long, or its O word stands wrong) leaves the line recorded and no block
  /// open.
  Result<void, ParseError> add(std::string_view text, std::uint32_t number, const OWord& word);
  /// The text is at its end: a block that is open is an error.
  Result<void, ParseError> close();
  /// Records a macro's text, whose lines count from 1. After an error nothing of it is left.
  Result<Range, ParseError> add_macro(std::string_view text);

  bool is_open() const { return !open_.empty(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(lines_.size()); }
  const Line& operator[](std::uint32_t index) const { return lines_[index]; }
  std::string_view text_of(const Line& line) const {
    return std::string_view(text_).substr(line.begin, line.size);
  }

  /// The subroutine O `label`.
  const Range* subroutine(const std::string& label) const;
  /// The numbered program O `number` among the lines from `begin` on: until the next one.
  std::optional<Range> program(int number, std::uint32_t begin) const;

  /// What is recorded so far stays.
  void keep();
  /// Where the lines begin that are not kept.
  std::uint32_t kept() const { return kept_.lines; }
  /// Drops what is not kept.
  void drop() { cut(kept_); }

 private:
  struct Size {
    std::uint32_t lines = 0;
    std::size_t text = 0;
  };
  struct Open {
    OKind kind{};
    std::uint32_t index = 0;
    std::uint32_t last_branch = 0;
    bool has_else = false;
  };

  Result<void, ParseError> nest(const OWord& word, std::uint32_t number, std::uint32_t index);
  Result<void, ParseError> wrong_end(const OWord& word, std::uint32_t number) const;
  void cut(Size size);

  std::string text_;
  std::vector<Line> lines_;
  std::vector<Open> open_;
  std::unordered_map<std::string, Range> subroutines_;
  Size kept_;
};

/// Nothing that could ever have an effect.
bool is_empty_line(std::string_view text);
/// An error of the text at a line and column.
Error<ParseError> wrong(std::uint32_t line, std::uint32_t column, Sentence message);

}  // namespace kinebus::gcode
