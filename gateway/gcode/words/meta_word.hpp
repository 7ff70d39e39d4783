#pragma once
// RepRapFirmware's meta commands: if, elif, else, while, break, continue, var, global, set, echo, abort. What
// belongs to if and while is indented.

#include <cstddef>
#include <string_view>
#include <vector>

#include "gateway/gcode/words/o_word.hpp"

namespace kinebus::gcode {

/// How far a line is indented; a tab goes to the next multiple of 4.
std::size_t indent_of(std::string_view line);

/// Whether the line may hold a meta command; false for the lines that jobs are made of. Costs a glance.
inline bool may_be_meta(std::string_view line) {
  std::size_t at = 0;
  while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
  const auto small = [](char c) { return c >= 'a' && c <= 'z'; };
  return at + 1 < line.size() && small(line[at]) && small(line[at + 1]);
}

/// The meta command at the line's beginning, with its indentation as label; kNone: there is none.
OWord read_meta_word(std::string_view line);

/// The blocks that are open, by how far their lines are indented.
class MetaBlocks {
 public:
  bool is_open() const { return !open_.empty(); }
  /// What a line of this indentation (and word) ends: the ends' words, to stand before it. Then it opens what
  /// it opens; break and continue get the label of their loop.
  std::vector<OWord> take(std::size_t indent, OWord& word);
  /// At the text's end.
  std::vector<OWord> close();

 private:
  struct Block {
    std::size_t indent = 0;
    bool loop = false;
  };
  OWord end_of(const Block& block) const;

  std::vector<Block> open_;
};

}  // namespace kinebus::gcode
