// What RepRapFirmware's var, global, set, echo and abort do.

#include <algorithm>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/letters.hpp"
#include "gateway/gcode/words/meta_expression.hpp"
#include "gateway/gcode/words/parameters.hpp"

namespace kinebus::gcode {
namespace {

MetaVariable* find(std::vector<MetaVariable>& all, std::string_view name) {
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const MetaVariable& each) { return each.name == name; });
  return at == all.end() ? nullptr : &*at;
}

bool ends_line(Cursor& cursor) {
  cursor.skip_blanks();
  return cursor.at_end() || *cursor.p == ';';
}

}  // namespace

bool Core::meta_command(const MetaLine& line, CommandBuffer& out) {
  out_ = &out;
  line_ = line.number;
  leave_meta_blocks(line.indent);
  const std::string_view text = line.text;
  Cursor cursor{text.data(), text.data() + line.rest_at, text.data() + text.size()};
  SyntaxError error;
  MetaReader reader(state_, cursor, error);
  const auto wrong = [&] { return fail(error.column, std::move(error.message)); };
  if (state_.modal.ended) begin_program();
  if (announce_) announce();
  if (line.word == "echo" || line.word == "abort") {
    std::string said;
    while (!ends_line(cursor)) {
      if (line.word == "echo" && *cursor.p == '>')
        return fail(cursor.column(), say("echo writes no files here: it tells the operator"));
      MetaValue value;
      if (!reader.read(value)) return wrong();
      said += (said.empty() ? "" : " ") + shown_value(value);
      if (said.size() > 2 * MetaReader::kMaxText)
        return fail(cursor.column(), say("the text is too long (500 letters at most)"));
      if (!cursor.accept(',') && !ends_line(cursor))
        return fail(cursor.column(), say("expected an operator or %1", ","));
    }
    if (line.word == "abort")
      return fail(line.column, said.empty() ? say("the job aborts itself here")
                                            : say("the job aborts itself here: %1", said));
    emit(canonical::Message{std::move(said)});
    return true;
  }
  std::string name;
  bool global = line.word == "global";
  const std::uint32_t name_column = cursor.column();
  if (!reader.read_name(name)) return wrong();
  if (line.word == "set") {
    global = name == "global";
    if ((!global && name != "var") || !cursor.accept('.'))
      return fail(name_column, say("set changes var.NAME or global.NAME"));
    if (!reader.read_name(name)) return wrong();
  }
  if (!cursor.accept('=')) return fail(cursor.column(), say("expected %1", "="));
  MetaValue value;
  if (!reader.read(value)) return wrong();
  if (!ends_line(cursor)) return fail(cursor.column(), say("nothing can follow the value"));
  std::vector<MetaVariable>& all = global ? state_.parameters.meta_globals : state_.parameters.meta_locals;
  MetaVariable* const known = find(all, name);
  const std::string full = (global ? "global." : "var.") + name;
  if (line.word == "set") {
    if (known == nullptr) return fail(name_column, say("%1 has no value yet", full));
    known->value = std::move(value);
    return true;
  }
  if (known != nullptr) return fail(name_column, say("%1 exists already: set changes it", full));
  if (all.size() >= MetaVariable::kMost)
    return fail(name_column, say("too many variables (%1 at most)", MetaVariable::kMost));
  all.push_back({std::move(name), std::move(value), global ? 0 : line.indent});
  return true;
}

bool Core::meta_condition(const MetaLine& line, bool& holds) {
  line_ = line.number;
  leave_meta_blocks(line.indent);
  Cursor cursor{line.text.data(), line.text.data() + line.rest_at, line.text.data() + line.text.size()};
  SyntaxError error;
  MetaReader reader(state_, cursor, error);
  if (!reader.read_condition(holds)) return fail(error.column, std::move(error.message));
  if (!ends_line(cursor)) return fail(cursor.column(), say("nothing can follow the value"));
  return true;
}

/// M98 P"prime.g" S5: the macro of this name, or of the file's without folder and ending; it reads param.S.
bool Core::macro_file_call() {
  std::string_view text = block_.text;
  if (text.starts_with('P') || text.starts_with('p')) text.remove_prefix(1);
  const std::size_t end = text.find('"', 1);
  const std::string_view name = text.substr(1, end == std::string_view::npos ? end : end - 1);
  std::string small = in_lower_case(name);
  if (find_macro(small) == nullptr) {
    small = small.substr(small.rfind('/') + 1);
    if (small.ends_with(".g")) small.resize(small.size() - 2);
  }
  if (find_macro(small) == nullptr)
    return fail(block_.text_column, say("there is no macro %1", std::string(name)));
  call_.what = ProgramCall::What::kMacro;
  call_.name = small;
  if (end == std::string_view::npos) return true;
  ParameterState named;
  SyntaxError error;
  Cursor cursor{text.data(), text.data() + end + 1, text.data() + text.size()};
  for (cursor.skip_blanks(); !ends_line(cursor) && *cursor.p != '('; cursor.skip_blanks()) {
    const char letter = in_lower_case(*cursor.p);
    if (letter < 'a' || letter > 'z')
      return fail(block_.text_column, say("the arguments of a macro are letters with numbers"));
    ++cursor.p;
    double value = 0;
    ValueReader reader(state_, cursor, error);
    if (!reader.starts_value() || !reader.read_value(value))
      return fail(block_.text_column, say("the arguments of a macro are letters with numbers"));
    write_named(named, std::string(1, letter), value);
  }
  call_.arguments = std::move(named.locals);
  return true;
}

/// A line so far indented stands outside of the blocks in which variables farther in were made.
void Core::leave_meta_blocks(std::size_t indent) {
  std::erase_if(state_.parameters.meta_locals,
                [indent](const MetaVariable& each) { return each.indent > indent; });
}

}  // namespace kinebus::gcode
