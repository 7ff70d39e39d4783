#include "gateway/gcode/words/meta_word.hpp"

#include <array>
#include <string>

namespace kinebus::gcode {
namespace {

struct Keyword {
  std::string_view text;
  OKind kind;
};
constexpr std::array<Keyword, 11> kKeywords = {{{"if", OKind::kIf},
                                                {"elif", OKind::kElseif},
                                                {"else", OKind::kElse},
                                                {"while", OKind::kWhile},
                                                {"break", OKind::kBreak},
                                                {"continue", OKind::kContinue},
                                                {"var", OKind::kMeta},
                                                {"global", OKind::kMeta},
                                                {"set", OKind::kMeta},
                                                {"echo", OKind::kMeta},
                                                {"abort", OKind::kMeta}}};

/// No O word has such a label.
std::string label_of(std::size_t indent) {
  return "{" + std::to_string(indent) + "}";
}

}  // namespace

std::size_t indent_of(std::string_view line) {
  std::size_t indent = 0;
  for (const char c : line) {
    if (c == ' ')
      ++indent;
    else if (c == '\t')
      indent = (indent + 4) / 4 * 4;
    else
      break;
  }
  return indent;
}

OWord read_meta_word(std::string_view line) {
  OWord word;
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return word;
  const std::string_view text = line.substr(first);
  for (const Keyword& keyword : kKeywords) {
    if (!text.starts_with(keyword.text)) continue;
    const char after = text.size() > keyword.text.size() ? text[keyword.text.size()] : ' ';
    const bool ends = after == ' ' || after == '\t' || after == '\r' || after == ';' || after == '{' ||
                      after == '(' || after == '!' || after == '"';
    if (!ends) continue;
    word.kind = keyword.kind;
    word.meta = true;
    word.label = label_of(indent_of(line));
    word.rest_at = first + keyword.text.size();
    word.column = static_cast<std::uint32_t>(first) + 1;
    return word;
  }
  return word;
}

OWord MetaBlocks::end_of(const Block& block) const {
  OWord end;
  end.kind = block.loop ? OKind::kEndwhile : OKind::kEndif;
  end.meta = true;
  end.label = label_of(block.indent);
  return end;
}

std::vector<OWord> MetaBlocks::take(std::size_t indent, OWord& word) {
  std::vector<OWord> ends;
  const bool branch = word.meta && (word.kind == OKind::kElseif || word.kind == OKind::kElse);
  while (!open_.empty() && open_.back().indent >= indent) {
    if (branch && open_.back().indent == indent && !open_.back().loop) break;
    ends.push_back(end_of(open_.back()));
    open_.pop_back();
  }
  if (!word.meta) return ends;
  if (word.kind == OKind::kIf || word.kind == OKind::kWhile)
    open_.push_back({indent, word.kind == OKind::kWhile});
  if (word.kind == OKind::kBreak || word.kind == OKind::kContinue)
    for (const Block& block : open_)
      if (block.loop) word.label = label_of(block.indent);  // the innermost is the last
  return ends;
}

std::vector<OWord> MetaBlocks::close() {
  std::vector<OWord> ends;
  for (; !open_.empty(); open_.pop_back()) ends.push_back(end_of(open_.back()));
  return ends;
}

}  // namespace kinebus::gcode
