#include "gateway/gcode/program.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinebus::gcode {
namespace {

bool is_loop(OKind kind) {
  return kind == OKind::kWhile || kind == OKind::kDo || kind == OKind::kRepeat;
}

/// Nothing that could ever have an effect.
bool is_empty_line(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string_view::npos || text[first] == ';';
}

std::string spelled(const OWord& word) {
  std::string text = o_name(word.label);
  text += ' ';
  text += o_keyword(word.kind);
  return text;
}

}  // namespace

Result<void, ParseError> Program::fail(std::uint32_t line, std::uint32_t column, Sentence message) {
  return Error<ParseError>({line, column, std::move(message)});
}

void Program::leave_all() {
  while (!frames_.empty()) {
    if (frames_.back().own_locals) interpreter_.swap_locals(frames_.back().locals);
    frames_.pop_back();
  }
  lines_.resize(kept_lines_);
  text_.resize(kept_text_);
}

Result<void, ParseError> Program::abandon(ParseError error) {
  const Frame& frame = frames_.back();
  if (frame.as_line != 0) {
    error.message = say("in the macro %1, line %2: %3", frame.name, error.line, error.message);
    error.line = frame.as_line;
    error.column = 1;
  } else if (frame.called_from != 0) {
    error.message = say("%1 (called in line %2)", error.message, frame.called_from);
  }
  leave_all();
  return Error<ParseError>(std::move(error));
}

std::uint32_t Program::shown_line(std::uint32_t number) const {
  return !frames_.empty() && frames_.back().as_line != 0 ? frames_.back().as_line : number;
}

Result<void, ParseError> Program::line(std::string_view text, std::uint32_t number, CommandBuffer& out) {
  const bool records = !open_.empty() || rest_;
  if (!may_be_o_word(text)) [[likely]] {
    if (passes_over_) return {};
    if (!records) [[likely]]
      return run_plain(text, number, out);
    OWord none;
    return is_empty_line(text) ? Result<void, ParseError>{} : record(text, number, none);
  }
  if (passes_over_) return {};
  OWord word;
  SyntaxError error;
  if (!read_o_word(text, word, error)) return fail(number, error.column, std::move(error.message));
  if (word.deleted && interpreter_.options().block_delete) return {};
  if (records) return record(text, number, word);
  switch (word.kind) {
    case OKind::kNone:
      return run_plain(text, number, out);
    case OKind::kCall:
      return call_o(text, word, number);
    case OKind::kProgram:
      if (std::exchange(named_, true))
        return fail(
            number, word.column,
            say("%1 begins a program before the one above it has ended with M30", o_name(word.label)));
      return {};
    default:
      if (use_ == Use::kLines)
        return fail(number, word.column, say("O words belong to a job: a single line can only call a macro"));
      return record(text, number, word);
  }
}

Result<void, ParseError> Program::run_plain(std::string_view text, std::uint32_t number, CommandBuffer& out) {
  auto result = interpreter_.execute(text, number, out);
  if (!result) return result;
  if (interpreter_.call().what != ProgramCall::What::kNone) [[unlikely]]
    return follow_call(number);
  return result;
}

// Recording.

Result<void, ParseError> Program::record(std::string_view text, std::uint32_t number, OWord& word) {
  if (text_.size() + text.size() > kMaxText || lines_.size() >= kMaxLines) {
    const std::uint32_t since = rest_ ? waiting_line_ : lines_[open_.front().index].line;
    open_.clear();
    rest_ = false;
    passes_over_ = true;
    return fail(number, 1,
                say("what has to be kept since line %1 is too long (16 MB or a million lines)", since));
  }
  const auto index = static_cast<std::uint32_t>(lines_.size());
  Recorded recorded;
  recorded.line = number;
  recorded.begin = static_cast<std::uint32_t>(text_.size());
  recorded.size = static_cast<std::uint32_t>(text.size());
  recorded.kind = word.kind;
  recorded.rest_at = static_cast<std::uint32_t>(word.rest_at);
  recorded.label = std::move(word.label);
  word.label = recorded.label;
  text_ += text;
  lines_.push_back(std::move(recorded));
  if (word.kind == OKind::kNone) return {};
  if (auto nested = nest(word, number, index); !nested) {
    open_.clear();
    rest_ = false;
    passes_over_ = true;
    return nested;
  }
  if (!open_.empty() || rest_) return {};
  if (word.kind == OKind::kEndsub) {
    kept_lines_ = lines_.size();
    kept_text_ = text_.size();
    return {};
  }
  Frame frame;
  frame.kind = FrameKind::kBlock;
  frame.at = frame.begin = static_cast<std::uint32_t>(kept_lines_);
  frame.end = static_cast<std::uint32_t>(lines_.size());
  frames_.push_back(std::move(frame));
  return {};
}

Result<void, ParseError> Program::wrong_end(const OWord& word, std::uint32_t number) {
  if (open_.empty()) return fail(number, word.column, say("%1 has no beginning", spelled(word)));
  const Recorded& open = lines_[open_.back().index];
  return fail(number, word.column,
              say("%1 stands where %2 of line %3 is open", spelled(word),
                  o_name(open.label) + " " + std::string(o_keyword(open_.back().kind)), open.line));
}

Result<void, ParseError> Program::nest(const OWord& word, std::uint32_t number, std::uint32_t index) {
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
      if (const auto known = subs_.find(word.label); known != subs_.end())
        return fail(number, word.column,
                    say("%1 is defined already, in line %2", o_name(word.label), known->second.line));
      open_.push_back({OKind::kSub, index, index, false});
      return {};
    case OKind::kEndsub: {
      if (!tops(OKind::kSub)) return wrong_end(word, number);
      const std::uint32_t begin = open_.back().index;
      subs_[word.label] = {begin + 1, index + 1, lines_[begin].line};
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
      if (open_.size() >= 100)
        return fail(number, word.column, say("O words are nested too deep (100 levels at most)"));
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
      return fail(number, word.column, say("%1 is in no loop of this label", spelled(word)));
    default:
      return {};
  }
}

Result<void, ParseError> Program::finish() {
  if (!open_.empty()) {
    const Recorded& open = lines_[open_.back().index];
    const std::string name = o_name(open.label) + " " + std::string(o_keyword(open_.back().kind));
    const std::uint32_t line = open.line;
    open_.clear();
    rest_ = false;
    passes_over_ = true;
    return fail(line, 1, say("%1 has no end", name));
  }
  if (!std::exchange(rest_, false)) return {};
  Frame frame;
  frame.kind = FrameKind::kRest;
  frame.at = frame.begin = static_cast<std::uint32_t>(rest_begin_);
  frame.end = static_cast<std::uint32_t>(lines_.size());
  frames_.push_back(std::move(frame));
  if (auto called = call_program(std::exchange(waiting_, {}), waiting_line_); !called)
    return abandon(called.error());
  return {};
}

// Carrying out.

Result<void, ParseError> Program::step(CommandBuffer& out) {
  Frame& frame = frames_.back();
  if (frame.at >= frame.end) {
    if (frame.kind == FrameKind::kProgram)
      return abandon(
          {lines_[frame.end - 1].line, 1, say("the program %1 has no M99 at its end", frame.name)});
    leave_frame();
    return {};
  }
  const std::uint32_t index = frame.at++;
  const std::uint64_t limit =
      use_ == Use::kLines ? kMaxLiveSteps : interpreter_.options().most_recorded_steps;
  if (++steps_ > limit)
    return abandon({lines_[index].line, 1,
                    say("loops and calls carry out more than %1 lines: one of them does not end", limit)});
  if (auto result = run(index, out); !result) return abandon(std::move(result.error()));
  if (interpreter_.ended()) leave_all();
  return {};
}

Result<double, ParseError> Program::value_of(const Recorded& line) {
  std::size_t at = line.rest_at;
  double value = 0;
  SyntaxError error;
  const std::string_view text = text_of(line);
  if (!interpreter_.evaluate(text, at, value, error))
    return Error<ParseError>({line.line, error.column, std::move(error.message)});
  return value;
}

Result<bool, ParseError> Program::condition(const Recorded& line) {
  const auto value = value_of(line);
  if (!value) return Error<ParseError>(value.error());
  return *value != 0;
}

Result<void, ParseError> Program::choose_branch(std::uint32_t index) {
  for (std::uint32_t at = index;; at = lines_[at].next) {
    if (lines_[at].kind == OKind::kIf || lines_[at].kind == OKind::kElseif) {
      const auto holds = condition(lines_[at]);
      if (!holds) return Error<ParseError>(holds.error());
      if (!*holds) continue;
    }
    frames_.back().at = at + 1;
    return {};
  }
}

void Program::leave_loops(std::uint32_t from) {
  auto& counters = frames_.back().counters;
  while (!counters.empty() && counters.back().loop >= from) counters.pop_back();
}

Result<void, ParseError> Program::repeat(std::uint32_t index) {
  const auto times = value_of(lines_[index]);
  if (!times) return Error<ParseError>(times.error());
  if (!(*times >= 0.5))
    frames_.back().at = lines_[index].next + 1;
  else
    frames_.back().counters.push_back({index, std::round(*times)});
  return {};
}

Result<void, ParseError> Program::run(std::uint32_t index, CommandBuffer& out) {
  Frame& frame = frames_.back();
  const Recorded& line = lines_[index];
  switch (line.kind) {
    case OKind::kNone:
      // A copy: what the line calls may be recorded behind it.
      return run_plain(std::string(text_of(line)), shown_line(line.line), out);
    case OKind::kProgram:
      return fail(line.line, 1,
                  say("%1 begins a program before the one above it has ended with M30", o_name(line.label)));
    case OKind::kSub:
      frame.at = line.next + 1;
      return {};
    case OKind::kEndsub:
    case OKind::kReturn:
      return give_back(line);
    case OKind::kCall: {
      const std::string text(text_of(line));
      OWord word;
      SyntaxError error;
      const std::uint32_t number = line.line;
      if (!read_o_word(text, word, error)) return fail(number, error.column, std::move(error.message));
      return call_o(text, word, number);
    }
    case OKind::kIf:
      return choose_branch(index);
    case OKind::kElseif:
    case OKind::kElse:
      frame.at = line.end + 1;
      return {};
    case OKind::kWhile:
    case OKind::kDoWhile: {
      const auto holds = condition(line);
      if (!holds) return Error<ParseError>(holds.error());
      if (line.kind == OKind::kWhile && !*holds) frame.at = line.next + 1;
      if (line.kind == OKind::kDoWhile && *holds) frame.at = line.next + 1;
      return {};
    }
    case OKind::kEndwhile:
      frame.at = line.next;
      return {};
    case OKind::kRepeat:
      return repeat(index);
    case OKind::kEndrepeat:
      if (--frame.counters.back().left > 0)
        frame.at = line.next + 1;
      else
        frame.counters.pop_back();
      return {};
    case OKind::kBreak:
      leave_loops(line.end);
      frame.at = lines_[line.end].next + 1;
      return {};
    case OKind::kContinue:
      leave_loops(line.end + 1);
      frame.at = lines_[line.end].kind == OKind::kWhile ? line.end : lines_[line.end].next;
      return {};
    case OKind::kEndif:
    case OKind::kDo:
      return {};
  }
  return {};
}

void Program::leave_frame() {
  Frame& frame = frames_.back();
  if (frame.repeats > 0) {
    --frame.repeats;
    frame.at = frame.begin;
    frame.counters.clear();
    return;
  }
  if (frame.own_locals) interpreter_.swap_locals(frame.locals);
  frames_.pop_back();
  if (frames_.empty()) leave_all();
}

Result<void, ParseError> Program::give_back(const Recorded& line) {
  const FrameKind kind = frames_.back().kind;
  if (kind == FrameKind::kBlock || kind == FrameKind::kRest)
    return fail(line.line, 1, say("%1 stands in no subroutine", std::string(o_keyword(line.kind))));
  const std::string_view text = text_of(line);
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
    return fail(line, column, say("calls are nested too deep (%1 levels at most)", kMaxDepth));
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
      return fail(number, error.column, std::move(error.message));
    if (!(value >= 0 && value < 1e9))
      return fail(number, word.column, say("an O number has 9 digits at most"));
    label = std::to_string(std::lround(value));
  }
  std::vector<double> arguments;
  std::size_t at = word.rest_at;
  for (;;) {
    at = text.find_first_not_of(" \t\r", at);
    if (at == std::string_view::npos || text[at] == ';' || text[at] == '(') break;
    const auto column = static_cast<std::uint32_t>(at) + 1;
    if (text[at] != '[') return fail(number, column, say("the arguments of a call stand in [ ]"));
    if (arguments.size() == kLocals) return fail(number, column, say("a call has 30 arguments at most"));
    double value = 0;
    if (!interpreter_.evaluate(text, at, value, error))
      return fail(number, error.column, std::move(error.message));
    arguments.push_back(value);
  }
  Frame frame;
  frame.kind = FrameKind::kSub;
  frame.name = o_name(label);
  frame.called_from = number;
  if (const auto sub = subs_.find(label); sub != subs_.end()) {
    frame.at = frame.begin = sub->second.begin;
    frame.end = sub->second.end;
    frame.as_line = frames_.empty() ? 0 : frames_.back().as_line;
  } else if (label.front() == '<' && interpreter_.has_macro(label.substr(1, label.size() - 2))) {
    ProgramCall call;
    call.what = ProgramCall::What::kMacro;
    call.name = label.substr(1, label.size() - 2);
    call.numbered = std::move(arguments);
    return call_macro(call, number);
  } else {
    return fail(number, word.column, say("%1 is not defined above this call", frame.name));
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
    case ProgramCall::What::kReturn:
      break;
  }
  if (frames_.empty() || frames_.back().kind == FrameKind::kBlock || frames_.back().kind == FrameKind::kRest)
    return fail(number, call.column,
                say("M99 ends a subprogram: a main program that begins again for ever is not run"));
  leave_frame();
  return {};
}

bool Program::has_rest_program(int number, Range& range) const {
  const std::string label = std::to_string(number);
  for (std::size_t i = rest_begin_; i < lines_.size(); ++i) {
    if (lines_[i].kind != OKind::kProgram || lines_[i].label != label) continue;
    std::size_t end = i + 1;
    while (end < lines_.size() && lines_[end].kind != OKind::kProgram) ++end;
    range = {static_cast<std::uint32_t>(i) + 1, static_cast<std::uint32_t>(end), lines_[i].line};
    return true;
  }
  return false;
}

Result<void, ParseError> Program::begin_rest(std::uint32_t number) {
  rest_ = true;
  rest_begin_ = lines_.size();
  waiting_line_ = number;
  return {};
}

Result<void, ParseError> Program::call_program(const ProgramCall& call, std::uint32_t number) {
  if (call.times <= 0) return {};
  int program = call.number, times = call.times;
  Range range;
  const bool in_rest = !frames_.empty() && frames_.front().kind == FrameKind::kRest;
  const auto find = [&](int wanted) {
    if (const auto sub = subs_.find(std::to_string(wanted)); sub != subs_.end()) {
      range = sub->second;
      return true;
    }
    return in_rest && has_rest_program(wanted, range);
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
      return fail(number, call.column, say("M98 P belongs to a job: a single line can only call a macro"));
    if (in_rest) return fail(number, call.column, say("there is no program O%1 in this text", program));
    if (!frames_.empty())
      return fail(number, call.column,
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
  if (known == macros_.end()) {
    // Recorded at its first call, as a subroutine without a label.
    const auto begin = static_cast<std::uint32_t>(lines_.size());
    std::string_view text = interpreter_.macro_text(call.name);
    for (std::uint32_t line = 1; !text.empty(); ++line) {
      const std::size_t end = text.find('\n');
      std::string_view part = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      if (!part.empty() && part.back() == '\r') part.remove_suffix(1);
      if (is_empty_line(part)) continue;
      OWord word;
      SyntaxError error;
      ParseError wrong;
      if (!read_o_word(part, word, error)) wrong = {line, error.column, std::move(error.message)};
      Recorded recorded;
      recorded.line = line;
      recorded.begin = static_cast<std::uint32_t>(text_.size());
      recorded.size = static_cast<std::uint32_t>(part.size());
      recorded.kind = word.kind;
      recorded.rest_at = static_cast<std::uint32_t>(word.rest_at);
      recorded.label = word.label;
      text_ += part;
      lines_.push_back(std::move(recorded));
      if (wrong.line == 0)
        if (auto nested = nest(word, line, static_cast<std::uint32_t>(lines_.size()) - 1); !nested)
          wrong = nested.error();
      if (wrong.line == 0) continue;
      open_.clear();
      return fail(number, 1, say("in the macro %1, line %2: %3", call.name, wrong.line, wrong.message));
    }
    if (!open_.empty()) {
      const std::uint32_t line = lines_[open_.back().index].line;
      open_.clear();
      return fail(number, 1, say("in the macro %1, line %2: an O word has no end", call.name, line));
    }
    kept_lines_ = lines_.size();
    kept_text_ = text_.size();
    known = macros_.emplace(call.name, Range{begin, static_cast<std::uint32_t>(lines_.size()), 0}).first;
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
