#include "gateway/gcode/core/core.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "gateway/gcode/words/parameters.hpp"

namespace kinebus::gcode {
namespace {

constexpr std::uint32_t kStraightWords = Block::bit('X') | Block::bit('Y') | Block::bit('Z') |
                                         Block::bit('A') | Block::bit('C') | Block::bit('E') |
                                         Block::bit('F');
constexpr std::size_t kMaxLine = 4096;
constexpr int kNoteForA = 99999, kNoteForDialect = 99998;  // keys of notes; below: M numbers

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
  m.threads = options_.spindle;
  m.tools = options_.tools, m.hotends = options_.hotends;
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
  if (modes_due_.modes && !restore_due_modes()) [[unlikely]]
    return false;
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
  if (!line.empty() && line.front() == ';' && read_object_comment(line)) [[unlikely]]
    return true;
  if (block_.is_plain() && !announce_ && !state_.modal.away && !state_.modal.ended &&
      state_.modal.cutter == CutterSide::kOff && state_.modal.nurbs == 0 && !state_.modal.surface_speed &&
      state_.modal.thread_mm == 0 && (block_.present & ~kStraightWords) == 0 && block_.present != 0) {
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
  if (!options_.macros.empty() && is_harmless() && call_code_macro(line)) return true;
  return run_careful();
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
  m.nurbs = 0;
  m.ended = false;
  m.content_seen = false;
  m.motion = Motion::kNone;
  m.plane = Plane::kXy;
  m.incremental = m.incremental_e = m.relative_extruder = m.absolute_centre = false;
  m.inverse_time = m.feed_per_turn = false;
  m.coordinate_system = 0;
  m.g92_active = false;
  m.tool_centre_point = m.tilted = false;
  m.tool_length_mm = 0;
  m.tool_xy_mm = {};
  m.spindle_turns = m.cycle = 0;
  m.thread_mm = 0;
  m.surface_speed = false;
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
  profile_ = {};
  follow_dialect();
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
  m.nurbs = 0;
  profile_ = {};
  refresh();
  announce_ = true;
}

void Core::swap_locals(Locals& locals) {
  std::swap_ranges(locals.numbers.begin(), locals.numbers.end(), state_.parameters.numbered.begin() + 1);
  std::swap(locals.names, state_.parameters.locals);
  std::swap(locals.variables, state_.parameters.meta_locals);
  std::swap(locals.saved, state_.saved);
}

void Core::end_subroutine() {
  if (state_.saved.modes && state_.saved.at_return) modes_due_ = state_.saved;
}

bool Core::is_harmless() const {
  return block_.harmless_g >= 0 || (block_.m_count > 0 && m_group(block_.m[0].number) == MGroup::kHarmless);
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
