// RepRapFirmware's meta commands among the lines of a text: what is indented is recorded, and carried out
// when a line farther out comes; that line goes behind it.
#include <algorithm>
#include <string>
#include <utility>

#include "gateway/gcode/programs/program.hpp"

namespace kinebus::gcode {

Result<void, ParseError> Program::add_ends(const std::vector<OWord>& ends, std::uint32_t number) {
  for (const OWord& end : ends)
    if (auto added = recording_.add({}, number, end); !added) return give_up(std::move(added.error()));
  return {};
}

Result<void, ParseError> Program::meta_line(std::string_view text, std::uint32_t number, CommandBuffer& out) {
  OWord word = interpreter_.takes_meta() ? read_meta_word(text) : OWord{};
  const bool was_open = blocks_.is_open();
  if (use_ == Use::kLines && word.meta && word.kind != OKind::kMeta)
    return wrong(number, word.column,
                 say("if and while belong to a job: a single line can only call a macro"));
  if (auto ended = add_ends(blocks_.take(indent_of(text), word), number); !ended) return ended;
  SyntaxError error;
  if (!word.meta && !read_o_word(text, word, error))
    return give_up({number, error.column, std::move(error.message)});
  if (!was_open && !blocks_.is_open() && !recording_.is_open() && !rest_ && word.kind == OKind::kMeta)
    return interpreter_.run_meta(meta_of(text, number, word.rest_at), out);
  if (auto added = recording_.add(text, number, word); !added) return give_up(std::move(added.error()));
  if (!recording_.is_open() && !rest_) begin_block();
  return {};
}

MetaLine Program::meta_of(std::string_view text, std::uint32_t number, std::size_t rest_at) const {
  MetaLine line;
  line.text = text;
  line.rest_at = rest_at;
  line.number = number;
  line.indent = indent_of(text);
  const std::size_t first = std::min(text.find_first_not_of(" \t"), rest_at);
  line.word = text.substr(first, rest_at - first);
  line.column = static_cast<std::uint32_t>(first) + 1;
  return line;
}

/// How often the innermost meta while of the frame at work was done, before one of its lines.
void Program::tell_iterations() {
  double done = -1;
  for (const Counter& counter : frames_.back().counters)
    if (recording_[counter.loop].meta) done = counter.left;
  interpreter_.set_iterations(done);
}

Result<bool, ParseError> Program::meta_condition(const Recording::Line& line) {
  return interpreter_.meta_condition(meta_of(recording_.text_of(line), line.number, line.rest_at));
}

Result<void, ParseError> Program::run_meta(const Recording::Line& line, CommandBuffer& out) {
  const std::string text(recording_.text_of(line));
  return interpreter_.run_meta(meta_of(text, shown_line(line.number), line.rest_at), out);
}

}  // namespace kinebus::gcode
