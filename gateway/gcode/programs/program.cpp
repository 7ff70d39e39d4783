#include "gateway/gcode/programs/program.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinebus::gcode {

void Program::leave_all() {
  interpreter_.set_iterations(-1);
  while (!frames_.empty()) {
    if (frames_.back().own_locals) interpreter_.swap_locals(frames_.back().locals);
    frames_.pop_back();
  }
  recording_.drop();
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
  profile_depth_ = 0;
  interpreter_.drop_profile();
  return Error<ParseError>(std::move(error));
}

std::uint32_t Program::shown_line(std::uint32_t number) const {
  return !frames_.empty() && frames_.back().as_line != 0 ? frames_.back().as_line : number;
}

Result<void, ParseError> Program::line(std::string_view text, std::uint32_t number, CommandBuffer& out) {
  const bool records = recording_.is_open() || rest_;
  if (blocks_.is_open() || may_be_meta(text)) [[unlikely]] {
    if (passes_over_ || is_empty_line(text)) return {};
    if (blocks_.is_open() || (interpreter_.takes_meta() && read_meta_word(text).meta))
      return meta_line(text, number, out);
  }
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
  if (!read_o_word(text, word, error)) return wrong(number, error.column, std::move(error.message));
  if (word.deleted && interpreter_.options().block_delete) return {};
  if (records) return record(text, number, word);
  switch (word.kind) {
    case OKind::kNone:
      return run_plain(text, number, out);
    case OKind::kCall:
      return call_o(text, word, number);
    case OKind::kProgram:
      if (std::exchange(named_, true))
        return wrong(
            number, word.column,
            say("%1 begins a program before the one above it has ended with M30", o_name(word.label)));
      return {};
    default:
      if (use_ == Use::kLines)
        return wrong(number, word.column,
                     say("O words belong to a job: a single line can only call a macro"));
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

Result<void, ParseError> Program::record(std::string_view text, std::uint32_t number, const OWord& word) {
  if (auto added = recording_.add(text, number, word); !added) return give_up(std::move(added.error()));
  if (word.kind == OKind::kNone || recording_.is_open() || rest_) return {};
  if (word.kind == OKind::kEndsub) {
    recording_.keep();
    return {};
  }
  begin_block();
  return {};
}

/// What is recorded since the last of its kind is carried out.
void Program::begin_block() {
  Frame frame;
  frame.kind = FrameKind::kBlock;
  frame.at = frame.begin = recording_.kept();
  frame.end = recording_.size();
  frames_.push_back(std::move(frame));
}

Result<void, ParseError> Program::give_up(ParseError error) {
  rest_ = false;
  passes_over_ = true;
  return Error<ParseError>(std::move(error));
}

Result<void, ParseError> Program::call_waiting_o() {
  const std::string text = std::exchange(waiting_o_, {});
  OWord word;
  SyntaxError error;
  if (!read_o_word(text, word, error)) return wrong(waiting_line_, error.column, std::move(error.message));
  return call_o(text, word, waiting_line_);
}

Result<void, ParseError> Program::finish() {
  if (blocks_.is_open() && !passes_over_) {
    if (auto ended = add_ends(blocks_.close(), 0); !ended) return ended;
    if (!recording_.is_open() && !rest_) begin_block();
  }
  if (auto closed = recording_.close(); !closed) return give_up(std::move(closed.error()));
  if (!std::exchange(rest_, false)) return {};
  Frame frame;
  frame.kind = FrameKind::kRest;
  frame.at = frame.begin = rest_begin_;
  frame.end = recording_.size();
  frames_.push_back(std::move(frame));
  auto called =
      waiting_o_.empty() ? call_program(std::exchange(waiting_, {}), waiting_line_) : call_waiting_o();
  return called ? Result<void, ParseError>{} : abandon(std::move(called.error()));
}

// Carrying out.

Result<void, ParseError> Program::step(CommandBuffer& out) {
  Frame& frame = frames_.back();
  if (frame.at >= frame.end) {
    if (frame.kind == FrameKind::kProgram)
      return abandon(
          {recording_[frame.end - 1].number, 1, say("the program %1 has no M99 at its end", frame.name)});
    leave_frame();
    return cut_profile(out);
  }
  const std::uint32_t index = frame.at++;
  const std::uint64_t limit =
      use_ == Use::kLines ? kMaxLiveSteps : interpreter_.options().most_recorded_steps;
  if (++steps_ > limit)
    return abandon({recording_[index].number, 1,
                    say("loops and calls carry out more than %1 lines: one of them does not end", limit)});
  tell_iterations();
  const bool in_macro = frame.as_line != 0;
  if (auto result = run(index, out); !result) {
    // A macro's lines go by the line that called; what is wrong goes by its own.
    if (in_macro) result.error().line = recording_[index].number;
    return abandon(std::move(result.error()));
  }
  if (interpreter_.ended()) leave_all();
  return cut_profile(out);
}

Result<double, ParseError> Program::value_of(const Recording::Line& line) {
  std::size_t at = line.rest_at;
  double value = 0;
  SyntaxError error;
  const std::string_view text = recording_.text_of(line);
  if (!interpreter_.evaluate(text, at, value, error))
    return Error<ParseError>({line.number, error.column, std::move(error.message)});
  return value;
}

Result<bool, ParseError> Program::condition(const Recording::Line& line) {
  if (line.meta) return meta_condition(line);
  const auto value = value_of(line);
  if (!value) return Error<ParseError>(value.error());
  return *value != 0;
}

Result<void, ParseError> Program::choose_branch(std::uint32_t index) {
  for (std::uint32_t at = index;; at = recording_[at].next) {
    if (recording_[at].kind == OKind::kIf || recording_[at].kind == OKind::kElseif) {
      const auto holds = condition(recording_[at]);
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
  const auto times = value_of(recording_[index]);
  if (!times) return Error<ParseError>(times.error());
  if (!(*times >= 0.5))
    frames_.back().at = recording_[index].next + 1;
  else
    frames_.back().counters.push_back({index, std::round(*times)});
  return {};
}

Result<void, ParseError> Program::run(std::uint32_t index, CommandBuffer& out) {
  Frame& frame = frames_.back();
  const Recording::Line& line = recording_[index];
  switch (line.kind) {
    case OKind::kNone:
      // A copy: what the line calls may be recorded behind it.
      return run_plain(std::string(recording_.text_of(line)), shown_line(line.number), out);
    case OKind::kProgram:
      return wrong(line.number, 1,
                   say("%1 begins a program before the one above it has ended with M30", o_name(line.label)));
    case OKind::kSub:
      frame.at = line.next + 1;
      return {};
    case OKind::kEndsub:
    case OKind::kReturn:
      return give_back(line);
    case OKind::kCall: {
      const std::string text(recording_.text_of(line));
      OWord word;
      SyntaxError error;
      const std::uint32_t number = line.number;
      if (!read_o_word(text, word, error)) return wrong(number, error.column, std::move(error.message));
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
      if (line.meta && (frame.counters.empty() || frame.counters.back().loop != index))
        frame.counters.push_back({index, 0});
      tell_iterations();
      const auto holds = condition(line);
      if (!holds) return Error<ParseError>(holds.error());
      if (line.kind == OKind::kWhile && !*holds) {
        frame.at = line.next + 1;
        if (line.meta) frame.counters.pop_back();
      }
      if (line.kind == OKind::kDoWhile && *holds) frame.at = line.next + 1;
      return {};
    }
    case OKind::kEndwhile:
      if (line.meta) ++frame.counters.back().left;
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
      frame.at = recording_[line.end].next + 1;
      return {};
    case OKind::kContinue:
      leave_loops(line.end + 1);
      if (line.meta) ++frame.counters.back().left;
      frame.at = recording_[line.end].kind == OKind::kWhile ? line.end : recording_[line.end].next;
      return {};
    case OKind::kMeta:
      return run_meta(line, out);
    case OKind::kEndif:
    case OKind::kDo:
      return {};
  }
  return {};
}

}  // namespace kinebus::gcode
