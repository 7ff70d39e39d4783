#include "gateway/gcode/programs/recording.hpp"

#include <utility>

#include "gateway/gcode/words/meta_word.hpp"

namespace kinebus::gcode {
namespace {

bool is_loop(OKind kind) {
  return kind == OKind::kWhile || kind == OKind::kDo || kind == OKind::kRepeat;
}

std::string spelled(OKind kind, std::string_view label) {
  // A meta command goes by its word alone.
  if (label.starts_with('{')) return std::string(kind == OKind::kElseif ? "elif" : o_keyword(kind));
  std::string text = o_name(label);
  text += ' ';
  text += o_keyword(kind);
  return text;
}

}  // namespace

bool is_empty_line(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string_view::npos || text[first] == ';';
}

Error<ParseError> wrong(std::uint32_t line, std::uint32_t column, Sentence message) {
  return Error<ParseError>({line, column, std::move(message)});
}

void Recording::cut(Size size) {
  std::erase_if(subroutines_, [&](const auto& known) { return known.second.end > size.lines; });
  lines_.resize(size.lines);
  text_.resize(size.text);
}

void Recording::keep() {
  kept_ = {size(), text_.size()};
}

Result<void, ParseError> Recording::add(std::string_view text, std::uint32_t number, const OWord& word) {
  if (text_.size() + text.size() > kMaxText || lines_.size() >= kMaxLines) {
    const std::uint32_t from = open_.empty() ? kept_.lines : open_.front().index;
    const std::uint32_t since = from < size() ? lines_[from].number : number;
    open_.clear();
    return wrong(number, 1,
                 say("what has to be kept since line %1 is too long (16 MB or a million lines)", since));
  }
  Line line;
  line.number = number;
  line.begin = static_cast<std::uint32_t>(text_.size());
  line.size = static_cast<std::uint32_t>(text.size());
  line.kind = word.kind;
  line.rest_at = static_cast<std::uint32_t>(word.rest_at);
  line.label = word.label;
  line.meta = word.meta;
  text_ += text;
  lines_.push_back(std::move(line));
  if (word.kind == OKind::kNone) return {};
  auto nested = nest(word, number, size() - 1);
  if (!nested) open_.clear();
  return nested;
}

Result<void, ParseError> Recording::close() {
  if (open_.empty()) return {};
  const Line& open = lines_[open_.back().index];
  const OKind kind = open_.back().kind;
  open_.clear();
  return wrong(open.number, 1, say("%1 has no end", spelled(kind, open.label)));
}

Result<Recording::Range, ParseError> Recording::add_macro(std::string_view text) {
  const Size before{size(), text_.size()};
  const auto refuse = [&](ParseError error) {
    open_.clear();
    cut(before);
    return Error<ParseError>(std::move(error));
  };
  MetaBlocks blocks;
  const auto end = [&](const std::vector<OWord>& ends, std::uint32_t number) -> Result<void, ParseError> {
    for (const OWord& each : ends)
      if (auto added = add({}, number, each); !added) return added;
    return {};
  };
  std::uint32_t number = 1;
  for (; !text.empty(); ++number) {
    const std::size_t stop = text.find('\n');
    std::string_view line = text.substr(0, stop);
    text.remove_prefix(stop == std::string_view::npos ? text.size() : stop + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (is_empty_line(line)) continue;
    OWord word = read_meta_word(line);
    SyntaxError error;
    if (auto ended = end(blocks.take(indent_of(line), word), number); !ended)
      return refuse(std::move(ended.error()));
    if (!word.meta && !read_o_word(line, word, error))
      return refuse({number, error.column, std::move(error.message)});
    if (auto added = add(line, number, word); !added) return refuse(std::move(added.error()));
  }
  if (auto ended = end(blocks.close(), number); !ended) return refuse(std::move(ended.error()));
  if (auto closed = close(); !closed) return refuse(std::move(closed.error()));
  return Range{before.lines, size(), 0};
}

const Recording::Range* Recording::subroutine(const std::string& label) const {
  const auto found = subroutines_.find(label);
  return found == subroutines_.end() ? nullptr : &found->second;
}

std::optional<Recording::Range> Recording::program(int number, std::uint32_t begin) const {
  const std::string label = std::to_string(number);
  for (std::uint32_t i = begin; i < size(); ++i) {
    if (lines_[i].kind != OKind::kProgram || lines_[i].label != label) continue;
    std::uint32_t end = i + 1;
    while (end < size() && lines_[end].kind != OKind::kProgram) ++end;
    return Range{i + 1, end, lines_[i].number};
  }
  return std::nullopt;
}

Result<void, ParseError> Recording::wrong_end(const OWord& word, std::uint32_t number) const {
  if (open_.empty())
    return wrong(number, word.column, say("%1 has no beginning", spelled(word.kind, word.label)));
  const Line& open = lines_[open_.back().index];
  return wrong(number, word.column,
               say("%1 stands where %2 of line %3 is open", spelled(word.kind, word.label),
                   spelled(open_.back().kind, open.label), open.number));
}

Result<void, ParseError> Recording::nest(const OWord& word, std::uint32_t number, std::uint32_t index) {
  const auto tops = [&](OKind kind) {
    return !open_.empty() && open_.back().kind == kind && lines_[open_.back().index].label == word.label;
  };
  const auto close = [&] {
    const std::uint32_t begin = open_.back().index;
    lines_[begin].next = index;
    lines_[index].next = begin;
    open_.pop_back();
  };
  switch (word.kind) {
    case OKind::kSub:
      if (!open_.empty()) return wrong_end(word, number);
      if (const auto known = subroutines_.find(word.label); known != subroutines_.end())
        return wrong(number, word.column,
                     say("%1 is defined already, in line %2", o_name(word.label), known->second.number));
      open_.push_back({OKind::kSub, index, index, false});
      return {};
    case OKind::kEndsub: {
      if (!tops(OKind::kSub)) return wrong_end(word, number);
      const std::uint32_t begin = open_.back().index;
      subroutines_[word.label] = {begin + 1, index + 1, lines_[begin].number};
      close();
      return {};
    }
    case OKind::kWhile:
      if (tops(OKind::kDo)) {
        lines_[index].kind = OKind::kDoWhile;
        close();
        return {};
      }
      [[fallthrough]];
    case OKind::kIf:
    case OKind::kDo:
    case OKind::kRepeat:
      if (open_.size() >= kMaxNested)
        return wrong(number, word.column, say("O words are nested too deep (%1 levels at most)", kMaxNested));
      open_.push_back({word.kind, index, index, false});
      return {};
    case OKind::kElseif:
    case OKind::kElse:
      if (!tops(OKind::kIf) || open_.back().has_else) return wrong_end(word, number);
      lines_[open_.back().last_branch].next = index;
      open_.back().last_branch = index;
      open_.back().has_else = word.kind == OKind::kElse;
      return {};
    case OKind::kEndif: {
      if (!tops(OKind::kIf)) return wrong_end(word, number);
      lines_[open_.back().last_branch].next = index;
      for (std::uint32_t at = open_.back().index; at != index; at = lines_[at].next) lines_[at].end = index;
      open_.pop_back();
      return {};
    }
    case OKind::kEndwhile:
      if (!tops(OKind::kWhile)) return wrong_end(word, number);
      close();
      return {};
    case OKind::kEndrepeat:
      if (!tops(OKind::kRepeat)) return wrong_end(word, number);
      close();
      return {};
    case OKind::kBreak:
    case OKind::kContinue:
      for (auto open = open_.rbegin(); open != open_.rend(); ++open) {
        if (!is_loop(open->kind) || lines_[open->index].label != word.label) continue;
        lines_[index].end = open->index;
        return {};
      }
      if (word.meta)
        return wrong(number, word.column, say("%1 is in no loop", spelled(word.kind, word.label)));
      return wrong(number, word.column,
                   say("%1 is in no loop of this label", spelled(word.kind, word.label)));
    default:
      return {};
  }
}

}  // namespace kinebus::gcode
