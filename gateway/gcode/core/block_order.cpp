// In which order the words of one line take effect.

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/words/parameters.hpp"

namespace kinebus::gcode {
namespace {

constexpr int kNoteForG = 100000;  // keys of notes: tenths of G numbers above this

/// Calibration and its like on printers; on mills pockets, which are not left out in silence.
bool moves_on_mills(int g_tenths) {
  return g_tenths == 120 || g_tenths == 320 || g_tenths == 340;
}

}  // namespace

bool Core::run_careful() {
  const ModalState before = state_.modal;
  const bool announce_before = announce_;
  const std::size_t size_before = out_->size();
  std::optional<CutterPath> cutter_before;
  if (before.cutter != CutterSide::kOff) cutter_before = state_.cutter;
  const std::size_t points_before = state_.nurbs.points.size(), knots_before = state_.nurbs.knots.size();
  std::optional<std::vector<ToolEntry>> tools_before;
  if (block_.has(GGroup::kNonmodal) && block_.code(GGroup::kNonmodal).number == 100)
    tools_before = state_.tools;
  uncompensated_ = size_before;
  if (state_.modal.ended) begin_program();
  if (announce_) announce();
  if (run_block() && (!before.away || leave_out(size_before, before))) return true;
  state_.modal = before;
  if (cutter_before) state_.cutter = std::move(*cutter_before);
  if (tools_before) state_.tools = std::move(*tools_before);
  if (before.nurbs != 0) {
    state_.nurbs.points.resize(points_before);
    state_.nurbs.weights.resize(points_before);
    state_.nurbs.knots.resize(knots_before);
  }
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
  if (state_.modal.nurbs != 0 && !check_beside_nurbs()) [[unlikely]]
    return false;
  const bool has_content = block_.groups != 0 || block_.m_count != 0 || block_.present != 0;
  if (has_content) state_.modal.content_seen = true;
  // A thread goes on in the next line with nothing but G33.
  const bool goes_on = block_.has(GGroup::kMotion) && block_.code(GGroup::kMotion).number == kThread &&
                       block_.m_count == 0 && !has('S');
  if ((has_content || !block_.command.empty()) && !goes_on) end_thread();
  for (const std::string_view text : block_.messages) emit(canonical::Message{std::string(text)});
  if (!block_.command.empty() && !run_command()) return false;
  if (options_.spindle && moves_on_mills(block_.harmless_g)) return fail(1, unknown_g(block_.harmless_g));
  if (block_.harmless_g >= 0)
    note(kNoteForG + block_.harmless_g, say("%1 has no effect on this machine", g_name(block_.harmless_g)));

  // Units first: they hold for every length of the line. Then codes that own words (M207 F) before those
  // words' usual owners, modes, actions without motion, motion, and last what stops the program.
  if (block_.has(GGroup::kUnits)) state_.modal.inches = block_.code(GGroup::kUnits).number == 200;
  if (block_.has(GGroup::kSpindleMode) && !spindle_mode()) return false;
  for (int i = 0; i < block_.m_count; ++i) {
    const Code code = block_.m[static_cast<std::size_t>(i)];
    if (m_group(code.number) != MGroup::kStop && !run_machine_code(code)) return false;
  }
  if (!run_modes()) return false;
  if (block_.has(GGroup::kNonmodal) && !run_nonmodal(block_.code(GGroup::kNonmodal))) return false;
  if (!spindle_speed()) return false;
  tell_feed_per_turn();
  if (!run_motion()) return false;
  follow_surface(false);
  tell_feed_per_turn();
  if (!check_leftovers()) return false;
  for (int i = 0; i < block_.m_count; ++i)
    if (ends_program(block_.m[static_cast<std::size_t>(i)]) && !cutter_off()) return false;
  if (!compensate()) return false;
  if (profile_.at_work && !take_profile()) return false;
  // Last of what can be refused, so that a refused line assigns nothing.
  if (!assign_parameters()) return false;
  return run_stop() && compensate();
}

bool Core::run_nonmodal(Code code) {
  const bool uses_axes = code.number == 280 || (code.number == 300 && options_.spindle) ||
                         code.number == 920 || code.number == 520 || (code.number == 100 && has('L'));
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
      return is_stored(code) ? go_to_stored(code) : probe_once(code);
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
      return is_stored(code) ? go_to_stored(code) : home();
    case 281:
    case 301:
      return store_position(code);
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

}  // namespace kinebus::gcode
