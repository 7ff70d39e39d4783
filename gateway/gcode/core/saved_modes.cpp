// M70 to M73: the modal state of a subroutine or of the main program, kept and taken back (LinuxCNC).
#include <utility>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {

bool Core::saved_modes(Code code) {
  SavedModes& saved = state_.saved;
  switch (code.number) {
    case 71:
      saved = {};
      return true;
    case 72:
      return restore_modes(code.column);
    default:
      saved.modes = state_.modal;
      saved.at_return = code.number == 73;
      return true;
  }
}

/// Units, plane, distances, feed, path, coordinate system, tool length, G98/G99, spindle. Not: motion and
/// where anything stands.
bool Core::restore_modes(std::uint32_t column) {
  ModalState& m = state_.modal;
  if (!state_.saved.modes)
    return fail(column, say("no modal state is kept here: M70 or M73 keeps it, M71 forgets it"));
  const ModalState& kept = *state_.saved.modes;
  if (m.cutter != CutterSide::kOff)
    return fail(column,
                say("%1 cannot stand while cutter compensation is on: end it with G40 first", m_name(72)));
  if (m.tilted || kept.tilted)
    return fail(column, say("offsets cannot change in a tilted plane: end it with G69 first"));
  m.plane = kept.plane;
  m.inches = kept.inches;
  m.incremental = kept.incremental;
  m.incremental_e = kept.incremental_e;
  m.relative_extruder = kept.relative_extruder;
  m.absolute_centre = kept.absolute_centre;
  m.inverse_time = kept.inverse_time;
  m.feed_per_turn = kept.feed_per_turn;
  m.feed_known = kept.feed_known;
  m.feed_mm_per_s = kept.feed_mm_per_s;
  m.feed_rad_per_s = kept.feed_rad_per_s;
  m.retract_to_r = kept.retract_to_r;
  const bool path = m.exact_path != kept.exact_path || m.merge_lines != kept.merge_lines ||
                    m.path_tolerance_mm != kept.path_tolerance_mm ||
                    m.merge_tolerance_mm != kept.merge_tolerance_mm;
  m.exact_path = kept.exact_path;
  m.merge_lines = kept.merge_lines;
  m.path_tolerance_mm = kept.path_tolerance_mm;
  m.merge_tolerance_mm = kept.merge_tolerance_mm;
  if (path) emit(path_mode());
  const bool spindle = m.spindle_turns * m.spindle_rpm != kept.spindle_turns * kept.spindle_rpm;
  m.spindle_turns = kept.spindle_turns;
  m.spindle_rpm = kept.spindle_rpm;
  m.surface_speed = kept.surface_speed;
  m.surface_m_per_min = kept.surface_m_per_min;
  m.surface_most_rpm = kept.surface_most_rpm;
  if (spindle) emit(canonical::Spindle{m.spindle_turns * m.spindle_rpm});
  m.coordinate_system = kept.coordinate_system;
  m.tool_length_mm = kept.tool_length_mm;
  m.tool_xy_mm = kept.tool_xy_mm;
  m.tool_centre_point = kept.tool_centre_point;
  change_frame();
  return true;
}

bool Core::restore_due_modes() {
  std::swap(modes_due_, state_.saved);
  if (announce_) announce();
  const bool restored = restore_modes(1);
  state_.saved = std::exchange(modes_due_, {});
  return restored;
}

}  // namespace kinebus::gcode
