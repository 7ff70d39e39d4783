#include "gateway/gcode/core/core.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "gateway/gcode/words/parameters.hpp"

namespace kinebus::gcode {
namespace {

constexpr std::uint32_t kStraightWords = Block::bit('X') | Block::bit('Y') | Block::bit('Z') |
                                         Block::bit('A') | Block::bit('C') | Block::bit('E') |
                                         Block::bit('F');
constexpr std::size_t kMaxLine = 4096;
constexpr int kNoteForA = 99999, kNoteForDialect = 99998;
constexpr int kNoteForG = 100000;  // keys of notes: M numbers, G tenths above this

}  // namespace

Core::Core(Options options) : options_(std::move(options)) {
  ModalState& m = state_.modal;
  m.position = in_frame(options_.start, Frame::kMachine, m.frame);
  m.feed_known = options_.default_feed_mm_per_s > 0;
  m.feed_mm_per_s = options_.default_feed_mm_per_s;
  m.feed_rad_per_s = options_.default_feed_mm_per_s * std::numbers::pi / 180;
  m.retract_length_mm = options_.retract_length_mm;
  m.retract_mm_per_s = options_.retract_mm_per_s;
  m.retract_lift_mm = options_.retract_lift_mm;
  m.recover_extra_mm = options_.recover_extra_mm;
  m.recover_mm_per_s = options_.recover_mm_per_s;
  m.coordinate_offsets = options_.work_offsets;
  set_dialect(options_.dialect);
  m.e_canonical_base_mm = m.position[kAxisE];
  refresh();
}

void Core::follow_dialect() {
  const Dialect dialect = state_.modal.dialect;
  rules_ = &rules_of(dialect);
  const bool general = dialect == Dialect::kGeneral;
  traverse_has_feed_ = general ? options_.traverse_uses_feed : rules_->traverse_has_feed;
}

void Core::set_dialect(Dialect dialect) {
  state_.modal.dialect = dialect;
  follow_dialect();
  if (rules_->a_extrudes && !options_.spindle) state_.modal.a_extrudes = true;
}

bool Core::fail(std::uint32_t column, Sentence message) {
  error_.line = line_;
  error_.column = column;
  error_.message = std::move(message);
  return false;
}

bool Core::execute(std::string_view line, std::uint32_t line_number, CommandBuffer& out) {
  out_ = &out;
  line_ = line_number;
  SyntaxError error;
  if (!read_block(line, state_, block_, error)) {
    if (!options_.macros.empty() && call_code_macro(line)) return true;
    return fail(error.column, std::move(error.message));
  }
  used_ = 0;
  if (block_.a_taken) [[unlikely]]
    note(kNoteForA,
         rules_->a_extrudes
             ? say("A is taken for extrusion (E), as slicers write it for %1", std::string(rules_->name))
             : say("A is taken for extrusion (E), as the slicer in the file's header writes it"));
  if (watches_comments_ && !line.empty() && line.front() == ';') [[unlikely]]
    return read_object_comment(line);
  if (block_.is_plain() && !announce_ && !state_.modal.away && !state_.modal.ended &&
      state_.modal.cutter == CutterSide::kOff && (block_.present & ~kStraightWords) == 0 &&
      block_.present != 0) {
    const int g = block_.has(GGroup::kMotion) ? block_.code(GGroup::kMotion).number : -1;
    const Motion motion = g == 10  ? Motion::kFeed
                          : g == 0 ? Motion::kTraverse
                          : g < 0  ? state_.modal.motion
                                   : Motion::kNone;
    if (motion == Motion::kFeed || motion == Motion::kTraverse) {
      // A straight move checks everything before it changes anything.
      if (!run_straight(motion == Motion::kTraverse)) return false;
      state_.modal.motion = motion;
      state_.modal.cycle = 0;
      state_.modal.spline = false;
      return true;
    }
  }
  if (line.size() > kMaxLine && !block_.is_plain())
    return fail(kMaxLine + 1, say("the line is longer than 4096 bytes"));
  return run_careful();
}

bool Core::run_careful() {
  const ModalState before = state_.modal;
  const bool announce_before = announce_;
  const std::size_t size_before = out_->size();
  std::optional<CutterPath> cutter_before;
  if (before.cutter != CutterSide::kOff) cutter_before = state_.cutter;
  uncompensated_ = size_before;
  if (state_.modal.ended) begin_program();
  if (announce_) announce();
  if (run_block() && (!before.away || leave_out(size_before, before))) return true;
  state_.modal = before;
  if (cutter_before) state_.cutter = std::move(*cutter_before);
  follow_dialect();
  announce_ = announce_before;
  call_ = {};
  out_->resize(size_before);
  refresh_shift();
  return false;
}

bool Core::run_block() {
  if (block_.percent) {
    if (!state_.modal.content_seen) {
      state_.modal.content_seen = true;
    } else {
      emit(canonical::End{});
      state_.modal.ended = true;
    }
    return compensate();
  }
  if (block_.deleted && options_.block_delete) return true;
  const bool has_content = block_.groups != 0 || block_.m_count != 0 || block_.present != 0;
  if (has_content) state_.modal.content_seen = true;
  for (const std::string_view text : block_.messages) emit(canonical::Message{std::string(text)});
  if (!block_.command.empty() && !run_command()) return false;
  if (block_.harmless_g >= 0)
    note(kNoteForG + block_.harmless_g, say("%1 has no effect on this machine", g_name(block_.harmless_g)));

  // Units first: they hold for every length of the line. Then codes that own words (M207 F) before those
  // words' usual owners, modes, actions without motion, motion, and last what stops the program.
  if (block_.has(GGroup::kUnits)) state_.modal.inches = block_.code(GGroup::kUnits).number == 200;
  for (int i = 0; i < block_.m_count; ++i) {
    const Code code = block_.m[static_cast<std::size_t>(i)];
    if (m_group(code.number) != MGroup::kStop && !run_machine_code(code)) return false;
  }
  if (!run_modes()) return false;
  if (block_.has(GGroup::kNonmodal) && !run_nonmodal(block_.code(GGroup::kNonmodal))) return false;
  if (!spindle_speed()) return false;
  if (!run_motion()) return false;
  if (!check_leftovers()) return false;
  for (int i = 0; i < block_.m_count; ++i)
    if (ends_program(block_.m[static_cast<std::size_t>(i)]) && !cutter_off()) return false;
  if (!compensate()) return false;
  // Last of what can be refused, so that a refused line assigns nothing.
  if (!assign_parameters()) return false;
  return run_stop() && compensate();
}

bool Core::run_nonmodal(Code code) {
  const bool uses_axes =
      code.number == 280 || code.number == 920 || code.number == 520 || (code.number == 100 && has('L'));
  const Code motion = block_.code(GGroup::kMotion);
  if (uses_axes && block_.has(GGroup::kMotion))
    return fail(code.column, say("%1 and %2 would both use the line's axis words: write them in two lines",
                                 g_name(code.number), g_name(motion.number)));
  switch (code.number) {
    case 40:
      return dwell();
    case 100:
      if (has('L')) return set_coordinate_system();
      if (rules_->g10 == DialectRules::G10::kOffsets && !state_.modal.a_extrudes)
        return fail(code.column, say("G10 needs L2 or L20 in this dialect (%1)", std::string(rules_->name)));
      if (rules_->g10 == DialectRules::G10::kByWords && (has('P') || has('S'))) return tool_temperature('P');
      pass_over('S');
      return retract();
    case 300:
      return probe_once(code);
    case 290:
      return level_bed();
    case 520:
      return set_local_offset(code);
    case 110:
      return recover();
    case 220:
    case 230:
      // Machinekit's retraction of PrusaSlicer; to mills a stroke check, which the machine file states.
      if (rules_->p_is_value && state_.modal.a_extrudes) return code.number == 220 ? retract() : recover();
      for (char letter = 'A'; letter <= 'Z'; ++letter)
        if (letter != 'F') pass_over(letter);
      note(kNoteForG + code.number, say("%1 has no effect on this machine", g_name(code.number)));
      return true;
    case 280:
      return home();
    case 531:
      return orient_tool();
    case 530:
      return true;  // changes how run_motion() reads the axis words
    default:
      return set_g92(code);
  }
}

bool Core::assign_parameters() {
  if (block_.assignments.empty()) return true;
  for (const Assignment& assignment : block_.assignments) {
    const int index = assignment.target.index;
    if (index == 0) continue;
    if (parameter_use(index) != ParameterUse::kReadWrite)
      return fail(assignment.column, say("%1 can only be read", "#" + std::to_string(index)));
    if (is_offset_parameter(index) && state_.modal.tilted)
      return fail(assignment.column, say("offsets cannot change in a tilted plane: end it with G69 first"));
    if (is_offset_parameter(index) && cutter_is_on())
      return fail(assignment.column,
                  say("%1 cannot stand while cutter compensation is on: end it with G40 first",
                      "#" + std::to_string(index)));
    if (!(std::abs(assignment.value) <= 1e9) && is_offset_parameter(index))
      return fail(assignment.column, say("the offset is too large (10^9 at most)"));
  }
  std::size_t new_names = 0;
  for (const Assignment& assignment : block_.assignments) {
    if (assignment.target.index != 0) continue;
    if (is_predefined(assignment.target.name))
      return fail(assignment.column, say("%1 can only be read", "#<" + assignment.target.name + ">"));
    if (!read_named(state_, assignment.target.name)) ++new_names;
  }
  if (state_.parameters.named.size() + state_.parameters.locals.size() + new_names >
      ParameterState::kMaxNamed)
    return fail(block_.assignments.front().column, say("too many named parameters (1000 at most)"));
  for (const Assignment& assignment : block_.assignments) {
    if (assignment.target.index != 0)
      write_parameter(state_, assignment.target.index, assignment.value);
    else
      write_named(state_.parameters, assignment.target.name, assignment.value);
  }
  refresh();
  return true;
}

bool Core::check_leftovers() {
  const std::uint32_t left = block_.present & ~used_;
  if (left == 0) return true;
  // The leftmost of them.
  char letter = 0;
  for (char c = 'A'; c <= 'Z'; ++c)
    if ((left & Block::bit(c)) != 0 && (letter == 0 || block_.column_of(c) < block_.column_of(letter)))
      letter = c;
  const std::string name(1, letter);
  if (letter == 'U' || letter == 'V' || letter == 'W' || letter == 'B')
    return fail(block_.column_of(letter),
                say("the machine has no axis %1; its axes are X Y Z A C and E", name));
  for (const char axis : kAxisLetters)
    if (axis == letter)
      return fail(block_.column_of(letter),
                  say("%1 has no use in this line: no motion code is given or active", name));
  return fail(block_.column_of(letter), say("%1 has no use in this line", name));
}

void Core::finish(std::uint32_t line_number, CommandBuffer& out) {
  out_ = &out;
  line_ = line_number;
  if (state_.modal.ended) return;
  if (announce_) announce();
  Sentence unheard;  // the reader ends compensation by G40 first, and hears
  if (cutter_is_on()) static_cast<void>(state_.cutter.end(out, unheard));
  emit(canonical::End{});
  state_.modal.ended = true;
}

void Core::begin_program() {
  // RS274/NGC, 3.6.1 (M2, M30): what the end of a program resets.
  ModalState& m = state_.modal;
  if (std::exchange(m.away, false)) m.position = m.real_position;
  if (m.cutter != CutterSide::kOff) end_beside();
  m.ended = false;
  m.content_seen = false;
  m.motion = Motion::kNone;
  m.plane = Plane::kXy;
  m.incremental = m.incremental_e = m.relative_extruder = m.absolute_centre = m.inverse_time = false;
  m.coordinate_system = 0;
  m.g92_active = false;
  m.tool_centre_point = m.tilted = false;
  m.tool_length_mm = 0;
  m.spindle_turns = m.cycle = 0;
  m.object = -1;
  m.left_out = false;
  m.retract_to_r = m.spline = m.plane_rotation = m.a_extrudes = false;
  set_dialect(options_.dialect);
  m.feed_known = options_.default_feed_mm_per_s > 0;
  m.traverse_limited = false;
  m.feed_mm_per_s = options_.default_feed_mm_per_s;
  m.feed_rad_per_s = options_.default_feed_mm_per_s * std::numbers::pi / 180;
  m.position = in_frame(m.position, m.frame, wanted_frame());
  m.frame = wanted_frame();
  refresh();
  announce_ = true;
}

void Core::restore(const State& state) {
  state_ = state;
  follow_dialect();
  watches_comments_ = std::any_of(state_.objects.begin(), state_.objects.end(),
                                  [](const PrintObject& object) { return object.excluded; });
  announce_ = true;
  refresh_shift();
}

void Core::set_position(const Pose& pose, Frame frame) {
  ModalState& m = state_.modal;
  const double e = m.position[kAxisE];
  m.position = in_frame(pose, frame, m.frame);
  m.position[kAxisE] = e;
  if (m.away) {
    const double real_e = m.real_position[kAxisE];
    m.real_position = m.position;
    m.real_position[kAxisE] = real_e;
    m.real_frame = m.frame;
  }
  m.lifted_mm = 0;
  m.cutter = CutterSide::kOff;
  refresh();
  announce_ = true;
}

void Core::swap_locals(Locals& locals) {
  std::swap_ranges(locals.numbers.begin(), locals.numbers.end(), state_.parameters.numbered.begin() + 1);
  std::swap(locals.names, state_.parameters.locals);
}

void Core::set_returned(double value, bool given) {
  write_named(state_.parameters, "_value", value);
  write_named(state_.parameters, "_value_returned", given ? 1 : 0);
}

bool Core::read_header(std::string_view comment, std::uint32_t line_number) {
  const Header header = read_dialect(comment);
  line_ = line_number;
  if (!header.volumetric.empty())
    return fail(1, say("the header names %1, which measures extrusion in mm^3: have the slicer write Marlin",
                       std::string(header.volumetric)));
  ModalState& m = state_.modal;
  if (header.dialect && options_.dialect == Dialect::kGeneral && m.dialect != *header.dialect) {
    set_dialect(*header.dialect);
    note(kNoteForDialect,
         say("the header names %1, and the text is read as that dialect", std::string(rules_->name)));
  }
  // PrusaSlicer and Slic3r write A for Mach3 and Machinekit, and turn no axes.
  if (header.a_extrudes) m.a_extrudes = true;
  return true;
}

const Macro* Core::find_macro(std::string_view name) const {
  for (const Macro& macro : options_.macros)
    if (macro.name == name) return &macro;
  return nullptr;
}

void Core::announce() {
  announce_ = false;
  out_->push_back({line_, canonical::SetPosition{state_.modal.position, state_.modal.frame}});
}

canonical::Command& Core::emit(canonical::Command command) {
  return out_->emplace_back(canonical::Line{line_, std::move(command)}).command;
}

void Core::note(int key, Sentence text) {
  if (std::find(noted_.begin(), noted_.end(), key) != noted_.end()) return;
  noted_.push_back(key);
  notes_.push_back({line_, std::move(text)});
}

bool Core::take(char letter, double& value) {
  const std::uint32_t bit = Block::bit(letter);
  const std::string name(1, letter);
  if ((used_ & bit) != 0)
    return fail(block_.column_of(letter),
                say("two codes of this line would both use %1: write them in two lines", name));
  if (block_.is_bare(letter)) return fail(block_.column_of(letter), say("%1 needs a number", name));
  used_ |= bit;
  value = block_[letter];
  return true;
}

bool Core::take_if_given(char letter, double& value) {
  return !block_.has(letter) || take(letter, value);
}

bool Core::take_integer(char letter, int lowest, int highest, int& value) {
  if (!block_.has(letter)) return true;
  double number = 0;
  if (!take(letter, number)) return false;
  if (number < lowest || number > highest || std::abs(number - std::round(number)) > 1e-4)
    return fail(block_.column_of(letter),
                say("%1 must be a whole number from %2 to %3", std::string(1, letter), lowest, highest));
  value = static_cast<int>(std::lround(number));
  return true;
}

double Core::axis_value(int axis, double value) const {
  return axis == kAxisA || axis == kAxisC ? value * (std::numbers::pi / 180) : length(value);
}

}  // namespace kinebus::gcode
