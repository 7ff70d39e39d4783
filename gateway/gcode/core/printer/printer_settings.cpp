// M codes that set a printer's limits, retraction and overrides, and those for what the machine file says
// here.

#include <algorithm>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/letters.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kLargestRatio = 10;  // M220 S1000

}  // namespace

// What a printer's firmware keeps in its memory and a machine file says here. What would move the tool
// elsewhere when it is passed over is refused.
bool Core::firmware_setting(Code code) {
  const std::string name = m_name(code.number);
  if (code.number == 906 || code.number == 907) {
    note(code.number, say("%1 has no effect in a job: run_current_ma and hold_current_ma of [joint.NAME] in "
                          "the machine file say what a motor gets; M906 on the console or of a print host "
                          "sets it",
                          name));
    return true;
  }
  const bool moves_the_tool = code.number == 206 || code.number == 665 || code.number == 666;
  if (moves_the_tool && (block_.text.empty() || block_.text.front() == '(')) {
    note(code.number, say("%1 has no effect on this machine", name));
    return true;
  }
  switch (code.number) {
    case 206:
      return fail(block_.text_column,
                  say("M206 is not supported: write G10 L2 P0 with the values of the other sign"));
    case 665:
      return fail(block_.text_column,
                  say("M665 is not supported: write the geometry under [kinematics] in the machine file"));
    case 666:
      return fail(
          block_.text_column,
          say("M666 is not supported: write offset_mm of [joint.NAME.calibration] in the machine file"));
    case 92:
      note(92,
           say("M92 has no effect: mm_per_turn, full_steps_per_turn and microsteps of [joint.NAME] in the "
               "machine file say how far a step goes"));
      return true;
    case 143:
      note(143,
           say("%1 has no effect: max_c of [heater.NAME] in the machine file says what a job may ask for",
               name));
      return true;
    case 302:
      note(302,
           say("%1 has no effect: min_extrude_c of [thermal] in the machine file says below what nothing "
               "is fed",
               name));
      return true;
    case 305:
    case 308:
      note(code.number,
           say("%1 has no effect: sensor of [heater.NAME] in the machine file says what a heater "
               "is measured by",
               name));
      return true;
    case 306:
    case 307:
      note(code.number,
           say("%1 has no effect: a heater's node measures its model: kinebus tune NAME, or M303", name));
      return true;
    default:
      note(code.number, say("%1 has no effect: a heater's control belongs to its node and to [heater.NAME] "
                            "in the machine file",
                            name));
      return true;
  }
}

bool Core::axis_limits(Code code) {
  canonical::Limits command;
  auto& values = code.number == 201 ? command.axis_accel_per_s2 : command.axis_speed_per_s;
  bool any = false;
  for (int axis = 0; axis < kAxes; ++axis) {
    const char letter = kAxisLetters[static_cast<std::size_t>(axis)];
    double value = 0;
    if (!has(letter)) continue;
    if (!take(letter, value)) return false;
    if (!(value > 0)) return fail(block_.column_of(letter), say("a limit must be greater than 0"));
    if (code.number == 203 && rules_->m203_per_minute) value /= 60;
    values[static_cast<std::size_t>(axis)] = axis_value(axis, value);
    any = true;
  }
  for (const char letter : {'U', 'V', 'W'}) pass_over(letter);  // axes of other machines
  if (!any) return fail(code.column, say("%1 needs at least one axis word", m_name(code.number)));
  emit(command);
  return true;
}

/// Repetier: M201 of printing moves, M202 of travel; the lowest of X and Y holds for both.
bool Core::axis_acceleration(Code code) {
  double lowest = 0;
  for (const char letter : {'X', 'Y'}) {
    double value = 0;
    if (!has(letter)) continue;
    if (!take(letter, value)) return false;
    if (!(value > 0)) return fail(block_.column_of(letter), say("a limit must be greater than 0"));
    value = length(value);
    lowest = lowest > 0 ? std::min(lowest, value) : value;
  }
  for (const char letter : {'Z', 'E'}) pass_over(letter);
  if (!(lowest > 0)) return fail(code.column, say("%1 needs at least one axis word", m_name(code.number)));
  canonical::Limits command;
  (code.number == 201 ? command.print_accel_mm_per_s2 : command.travel_accel_mm_per_s2) = lowest;
  emit(command);
  return true;
}

bool Core::acceleration_limits() {
  canonical::Limits command;
  double both = 0;
  const auto read = [&](char letter, double& value) {
    if (!has(letter)) return true;
    if (!take(letter, value)) return false;
    value = length(value);
    return value > 0 || fail(block_.column_of(letter), say("an acceleration must be greater than 0"));
  };
  // S is the older form: printing and travel.
  if (!read('S', both)) return false;
  command.print_accel_mm_per_s2 = command.travel_accel_mm_per_s2 = both;
  if (!read('P', command.print_accel_mm_per_s2) || !read('T', command.travel_accel_mm_per_s2) ||
      !read('R', command.retract_accel_mm_per_s2))
    return false;
  emit(command);
  return true;
}

bool Core::jerk() {
  for (const char letter : {'X', 'Y', 'Z', 'A', 'C', 'E', 'J', 'S', 'T', 'B', 'V'}) pass_over(letter);
  note(205, say("M205 (jerk, junction deviation) has no effect: corners are blended within the tolerance of "
                "G64 P"));
  return true;
}

bool Core::retract_settings(Code code) {
  ModalState& m = state_.modal;
  const bool is_retract = code.number == 207;
  double s = is_retract ? m.retract_length_mm : m.recover_extra_mm;
  double f = is_retract ? m.retract_mm_per_s : m.recover_mm_per_s;
  double z = m.retract_lift_mm;
  if (has('S')) {
    if (!take('S', s)) return false;
    s = length(s);
    if (is_retract && s < 0)
      return fail(block_.column_of('S'), say("the retraction's length cannot be negative"));
  }
  if (has('F')) {
    if (!take('F', f)) return false;
    f = length(f) / 60;
    if (!(f > 0)) return fail(block_.column_of('F'), say("F must be greater than 0"));
  }
  if (is_retract && has('Z')) {
    if (!take('Z', z)) return false;
    z = length(z);
    if (z < 0) return fail(block_.column_of('Z'), say("the retraction's lift cannot be negative"));
  }
  (is_retract ? m.retract_length_mm : m.recover_extra_mm) = s;
  (is_retract ? m.retract_mm_per_s : m.recover_mm_per_s) = f;
  m.retract_lift_mm = z;
  return true;
}

bool Core::override_ratio(Code code) {
  ModalState& m = state_.modal;
  const std::string name = m_name(code.number);
  double percent = 0;
  if (!has('S') && (block_.is_bare('B') || block_.is_bare('R'))) {
    // Marlin stores and restores the percentage around a change of filament.
    pass_over('B');
    pass_over('R');
    note(code.number, say("%1 has no effect on this machine", name + " B, R"));
    return true;
  }
  if (!has('S')) return fail(code.column, say("%1 needs a percentage S", name));
  if (!take('S', percent)) return false;
  const double ratio = percent / 100;
  if (!(ratio > 0 && ratio <= kLargestRatio))
    return fail(block_.column_of('S'), say("the percentage of %1 is above 0 and at most 1000", name));
  if (code.number == 220) {
    m.feed_ratio = ratio;
    emit(canonical::Override{ratio, 0});
  } else {
    pass_over('T');
    pass_over('D');
    base_e_here(m.program[kAxisE]);
    m.flow_ratio = ratio;
    emit(canonical::Override{0, ratio});
  }
  return true;
}

}  // namespace kinebus::gcode
