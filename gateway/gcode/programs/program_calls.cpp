// Calls and returns: subroutines, numbered programs and macros.
#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/gcode/programs/program.hpp"

namespace kinebus::gcode {
namespace {

/// As the O word of a macro's own subroutine has it: o100, o<name>.
std::string macro_label(const std::string& name) {
  const bool number = name.find_first_not_of("0123456789") == std::string::npos;
  return number ? name : "<" + name + ">";
}

}  // namespace

void Program::leave_frame() {
  Frame& frame = frames_.back();
  if (frame.repeats > 0) {
    --frame.repeats;
    frame.at = frame.begin;
    frame.counters.clear();
    return;
  }
  if (frame.own_locals) {
    interpreter_.end_subroutine();
    interpreter_.swap_locals(frame.locals);
  }
  frames_.pop_back();
  if (frames_.empty()) leave_all();
}

Result<void, ParseError> Program::give_back(const Recording::Line& line) {
  const FrameKind kind = frames_.back().kind;
  if (kind == FrameKind::kBlock || kind == FrameKind::kRest)
    return wrong(line.number, 1, say("%1 stands in no subroutine", std::string(o_keyword(line.kind))));
  const std::string_view text = recording_.text_of(line);
  const std::size_t first = text.find_first_not_of(" \t\r", line.rest_at);
  const bool gives = first != std::string_view::npos && text[first] == '[';
  double value = 0;
  if (gives) {
    const auto given = value_of(line);
    if (!given) return Error<ParseError>(given.error());
    value = *given;
  }
  leave_frame();
  interpreter_.set_returned(value, gives);
  return {};
}

Result<void, ParseError> Program::push(Frame frame, std::uint32_t column) {
  if (frames_.size() >= kMaxDepth) {
    const std::uint32_t line = frame.called_from;
    if (frame.own_locals) interpreter_.swap_locals(frame.locals);
    return wrong(line, column, say("calls are nested too deep (%1 levels at most)", kMaxDepth));
  }
  frames_.push_back(std::move(frame));
  return {};
}

Result<void, ParseError> Program::call_o(std::string_view text, const OWord& word, std::uint32_t number) {
  std::string label = word.label;
  SyntaxError error;
  if (label.empty()) {
    std::size_t at = word.label_at;
    double value = 0;
    if (!interpreter_.evaluate(text, at, value, error))
      return wrong(number, error.column, std::move(error.message));
    if (!(value >= 0 && value < 1e9))
      return wrong(number, word.column, say("an O number has 9 digits at most"));
    label = std::to_string(std::lround(value));
  }
  std::vector<double> arguments;
  std::size_t at = word.rest_at;
  for (;;) {
    at = text.find_first_not_of(" \t\r", at);
    if (at == std::string_view::npos || text[at] == ';') break;
    if (text[at] == '(') {
      at = text.find(')', at);
      if (at == std::string_view::npos) break;
      ++at;
      continue;
    }
    const auto column = static_cast<std::uint32_t>(at) + 1;
    if (text[at] != '[') return wrong(number, column, say("the arguments of a call stand in [ ]"));
    if (arguments.size() == kLocals) return wrong(number, column, say("a call has 30 arguments at most"));
    double value = 0;
    if (!interpreter_.evaluate(text, at, value, error))
      return wrong(number, error.column, std::move(error.message));
    arguments.push_back(value);
  }
  Frame frame;
  frame.kind = FrameKind::kSub;
  frame.name = o_name(label);
  frame.called_from = number;
  if (const auto* sub = recording_.subroutine(label)) {
    frame.at = frame.begin = sub->begin;
    frame.end = sub->end;
    frame.as_line = frames_.empty() ? 0 : frames_.back().as_line;
  } else if (const std::string name = label.front() == '<' ? label.substr(1, label.size() - 2) : label;
             interpreter_.has_macro(name)) {
    ProgramCall call;
    call.what = ProgramCall::What::kMacro;
    call.name = name;
    call.numbered = std::move(arguments);
    return call_macro(call, number);
  } else if (use_ == Use::kText && frames_.empty() && !rest_) {
    // It may stand below, behind the main program's end.
    waiting_o_ = text;
    return begin_rest(number);
  } else {
    const bool in_rest = !frames_.empty() && frames_.front().kind == FrameKind::kRest;
    return wrong(number, word.column,
                 in_rest ? say("there is no %1 in this text", frame.name)
                         : say("%1 is not defined above this call", frame.name));
  }
  frame.own_locals = true;
  std::copy(arguments.begin(), arguments.end(), frame.locals.numbers.begin());
  interpreter_.swap_locals(frame.locals);
  return push(std::move(frame), word.column);
}

Result<void, ParseError> Program::follow_call(std::uint32_t number) {
  const ProgramCall call = interpreter_.take_call();
  switch (call.what) {
    case ProgramCall::What::kNone:
      return {};
    case ProgramCall::What::kMacro:
      return call_macro(call, number);
    case ProgramCall::What::kProgram:
      return call_program(call, number);
    case ProgramCall::What::kProfile:
      return call_profile(call, number);
    case ProgramCall::What::kReturn:
      break;
  }
  if (frames_.empty() || frames_.back().kind == FrameKind::kBlock || frames_.back().kind == FrameKind::kRest)
    return wrong(number, call.column,
                 say("M99 ends a subprogram: a main program that begins again for ever is not run"));
  leave_frame();
  return {};
}

Result<void, ParseError> Program::call_profile(const ProgramCall& call, std::uint32_t number) {
  Frame frame;
  frame.kind = FrameKind::kSub;
  frame.name = o_name(std::to_string(call.number));
  frame.called_from = number;
  const auto* sub = recording_.subroutine(std::to_string(call.number));
  if (sub == nullptr) {
    interpreter_.drop_profile();
    return wrong(number, call.column, say("%1 is not defined above this call", frame.name));
  }
  frame.at = frame.begin = sub->begin;
  frame.end = sub->end;
  frame.as_line = frames_.empty() ? 0 : frames_.back().as_line;
  frame.own_locals = true;
  interpreter_.swap_locals(frame.locals);
  auto pushed = push(std::move(frame), call.column);
  if (pushed)
    profile_depth_ = frames_.size();
  else
    interpreter_.drop_profile();
  return pushed;
}

/// When the profile's subroutine has ended: what it is for. Its moves count as lines carried out.
Result<void, ParseError> Program::cut_profile(CommandBuffer& out) {
  if (profile_depth_ == 0 || frames_.size() >= profile_depth_) return {};
  profile_depth_ = 0;
  const std::size_t from = out.size();
  auto cut = interpreter_.cut_profile(out);
  steps_ += out.size() - from;
  return cut || frames_.empty() ? cut : abandon(std::move(cut.error()));
}

Result<void, ParseError> Program::begin_rest(std::uint32_t number) {
  rest_ = true;
  rest_begin_ = recording_.size();
  waiting_line_ = number;
  return {};
}

Result<void, ParseError> Program::call_program(const ProgramCall& call, std::uint32_t number) {
  if (call.times <= 0) return {};
  int program = call.number, times = call.times;
  Recording::Range range;
  const bool in_rest = !frames_.empty() && frames_.front().kind == FrameKind::kRest;
  const auto find = [&](int wanted) {
    if (const auto* sub = recording_.subroutine(std::to_string(wanted))) {
      range = *sub;
      return true;
    }
    const auto later = in_rest ? recording_.program(wanted, rest_begin_) : std::nullopt;
    if (later) range = *later;
    return later.has_value();
  };
  bool found = find(program);
  // The older form: the last four digits are the program, those before them how often.
  if (!found && program > 9999 && times == 1 && find(program % 10000)) {
    found = true;
    times = program / 10000;
    program %= 10000;
  }
  if (!found) {
    if (use_ == Use::kLines)
      return wrong(number, call.column, say("M98 P belongs to a job: a single line can only call a macro"));
    if (in_rest) return wrong(number, call.column, say("there is no program O%1 in this text", program));
    if (!frames_.empty())
      return wrong(number, call.column,
                   say("%1 is not defined above this call", "O" + std::to_string(program)));
    waiting_ = call;
    return begin_rest(number);
  }
  Frame frame;
  frame.kind = FrameKind::kProgram;
  frame.at = frame.begin = range.begin;
  frame.end = range.end;
  frame.called_from = number;
  frame.repeats = times - 1;
  frame.name = "O" + std::to_string(program);
  frame.as_line = frames_.empty() ? 0 : frames_.back().as_line;
  return push(std::move(frame), call.column);
}

Result<void, ParseError> Program::call_macro(const ProgramCall& call, std::uint32_t number) {
  auto known = macros_.find(call.name);
  if (known == macros_.end()) {  // recorded at its first call
    const auto range = recording_.add_macro(interpreter_.macro_text(call.name));
    if (!range)
      return wrong(number, 1,
                   say("in the macro %1, line %2: %3", call.name, range.error().line, range.error().message));
    recording_.keep();
    // A file of LinuxCNC's: the subroutine of its name, between others that it calls.
    const auto* own = recording_.subroutine(macro_label(call.name));
    known = macros_.emplace(call.name, own != nullptr && own->begin >= range->begin ? *own : *range).first;
  }
  Frame frame;
  frame.kind = FrameKind::kMacro;
  frame.at = frame.begin = known->second.begin;
  frame.end = known->second.end;
  frame.called_from = frame.as_line = number;
  frame.name = call.name;
  frame.own_locals = true;
  frame.locals.names = call.arguments;
  std::copy_n(call.numbered.begin(), std::min(call.numbered.size(), kLocals), frame.locals.numbers.begin());
  interpreter_.swap_locals(frame.locals);
  return push(std::move(frame), call.column);
}

}  // namespace kinebus::gcode
