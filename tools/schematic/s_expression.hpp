#pragma once
// Lists in brackets, as KiCad writes its files.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/result.hpp"

namespace kinebus::schematic {

/// What is wrong with a file, where.
struct FileError {
  std::string file;
  std::size_t line = 0;  ///< 0: the file as a whole
  std::string words;
  std::string text() const;
};

/// A word, or a list whose first item is usually a word that names it.
struct Expression {
  std::string word;  ///< empty for a list
  std::vector<Expression> items;
  std::size_t line = 0;

  bool is(std::string_view name) const { return !items.empty() && items.front().word == name; }
  /// The first item that is a list with this name, or nullptr.
  const Expression* find(std::string_view name) const;
  /// The word at this place, or "".
  std::string_view at(std::size_t index) const;
  /// The number at this place, or 0.
  double number(std::size_t index) const;
};

/// The one list of `text`. At most 100 lists deep.
Result<Expression, FileError> parse_expression(std::string_view text, const std::string& file);

}  // namespace kinebus::schematic
