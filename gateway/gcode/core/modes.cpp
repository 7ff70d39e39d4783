// Modal codes other than motion, F, T and G4.

#include <cmath>
#include <numbers>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {

bool Core::run_modes() {
  ModalState& m = state_.modal;
  if (m.cutter != CutterSide::kOff) [[unlikely]] {
    if (block_.has(GGroup::kCutter) && block_.code(GGroup::kCutter).number == 400 && !cutter_off())
      return false;
    if (!check_beside_cutter()) return false;
  }
  if (block_.has(GGroup::kFeedMode)) {
    const Code mode = block_.code(GGroup::kFeedMode);
    const bool inverse_time = mode.number == 930, per_turn = mode.number == 950;
    if (per_turn && !options_.spindle)
      return fail(mode.column,
                  say("feed for each turn (G95) needs a spindle, which this machine does not have"));
    // An F of the other mode means something else.
    if (inverse_time != m.inverse_time || per_turn != m.feed_per_turn) m.feed_known = false;
    m.inverse_time = inverse_time;
    m.feed_per_turn = per_turn;
  }
  if (has('F') && !m.inverse_time && !run_feed_word()) return false;
  if (has('T')) {
    const int last = options_.tools - 1;
    if (block_['T'] == -1 && !block_.is_bare('T')) {
      pass_over('T');  // RepRapFirmware: no tool
    } else {
      if (!block_.is_bare('T') && block_['T'] > last)
        return fail(block_.column_of('T'),
                    last > 0
                        ? say("the machine has no such tool: the last is T%1", last)
                        : say("the machine has one tool, T0; where T1 and T2 turned axes, write A and C"));
      const int before = hotend_in_use();
      if (!take_integer('T', 0, last, m.tool)) return false;
      tell_hotend(before);
    }
    // What a change of tools does there: P in RepRapFirmware, S L D in others.
    if (block_.groups == 0 && block_.m_count == 0)
      for (const char letter : {'P', 'S', 'L', 'D'}) pass_over(letter);
  }
  if (block_.has_m(6) && !change_tool()) return false;
  if (block_.has(GGroup::kPlane)) {
    const int number = block_.code(GGroup::kPlane).number;
    m.plane = number == 170 ? Plane::kXy : number == 180 ? Plane::kZx : Plane::kYz;
  }
  if (block_.has(GGroup::kToolLength) && !set_tool_length(block_.code(GGroup::kToolLength))) return false;
  if (block_.has(GGroup::kCoordinates) && !select_coordinate_system(block_.code(GGroup::kCoordinates)))
    return false;
  if (block_.has(GGroup::kPathMode) && !set_path_mode(block_.code(GGroup::kPathMode))) return false;
  if (block_.has(GGroup::kDistance)) {
    using Given = DialectRules::Extruder;
    m.incremental = block_.code(GGroup::kDistance).number == 910;
    if (rules_->extruder == Given::kG91Takes) m.incremental_e = m.incremental || m.relative_extruder;
    if (rules_->extruder == Given::kG90Sets) m.incremental_e = m.relative_extruder = m.incremental;
  }
  if (block_.has_m(82)) m.incremental_e = m.relative_extruder = false;
  if (block_.has_m(83)) m.incremental_e = m.relative_extruder = true;
  if (block_.has(GGroup::kRetract)) m.retract_to_r = block_.code(GGroup::kRetract).number == 990;
  if (block_.has(GGroup::kCentre)) m.absolute_centre = block_.code(GGroup::kCentre).number == 901;
  if (block_.has(GGroup::kTilt) && !set_tilt(block_.code(GGroup::kTilt))) return false;
  if (block_.has(GGroup::kCutter) && block_.code(GGroup::kCutter).number != 400)
    return cutter_on(block_.code(GGroup::kCutter));
  return true;
}

int Core::hotend_in_use() const {
  return std::min(state_.modal.tool, options_.hotends - 1);
}

void Core::tell_hotend(int before) {
  if (hotend_in_use() != before) emit(canonical::Tool{hotend_in_use()});
}

bool Core::change_tool() {
  ModalState& m = state_.modal;
  if (m.tool_in_spindle == m.tool) return true;
  m.tool_in_spindle = m.tool;
  if (m.spindle_turns != 0) emit(canonical::Spindle{0});
  m.spindle_turns = 0;
  emit(canonical::Message{say("put in the tool T%1, then go on", m.tool).english()});
  emit(canonical::Pause{false});
  return true;
}

bool Core::feed_from(double value, FeedRate& feed) {
  if (!(value > 0)) return fail(block_.column_of('F'), say("F must be greater than 0"));
  double per_minute = value;
  if (state_.modal.feed_per_turn) {
    // The S of this line counts: its turn comes later.
    const bool given = has('S') && !block_.is_bare('S') && block_['S'] >= 0 && !state_.modal.surface_speed;
    per_minute *= given ? block_['S'] : state_.modal.spindle_rpm;
    if (!(per_minute > 0))
      return fail(block_.column_of('F'), say("with G95 the spindle's speed S comes before F"));
  }
  feed.known = true;
  feed.mm_per_s = length(per_minute) / 60;
  feed.rad_per_s = per_minute * (std::numbers::pi / 180 / 60);
  return true;
}

bool Core::run_feed_word() {
  double value = 0;
  FeedRate feed;
  if (!take('F', value) || !feed_from(value, feed)) return false;
  state_.modal.feed_known = true;
  state_.modal.feed_mm_per_s = feed.mm_per_s;
  state_.modal.feed_rad_per_s = feed.rad_per_s;
  return true;
}

double Core::dwell_s(double p) const {
  const bool by_dialect =
      state_.modal.dialect == Dialect::kGeneral ? options_.spindle : rules_->dwell_p_seconds;
  const bool seconds = options_.dwell_p_unit == DwellUnit::kByDialect
                           ? by_dialect
                           : options_.dwell_p_unit == DwellUnit::kSeconds;
  return seconds ? p : p / 1000;
}

bool Core::dwell() {
  double p = 0, s = 0;
  // Of a machine with a spindle an S beside P is its speed.
  const bool has_p = block_.has('P'), has_s = block_.has('S') && !(has_p && options_.spindle);
  if (has_p && has_s) return fail(block_.column_of('S'), say("G4 takes P or S, not both"));
  if (!take_if_given('P', p) || (has_s && !take('S', s))) return false;
  const double seconds = has_s ? s : dwell_s(p);
  if (seconds < 0)
    return fail(block_.column_of(has_s ? 'S' : 'P'), say("G4 cannot wait for a negative time"));
  emit(canonical::Dwell{seconds});
  return true;
}

bool Core::set_path_mode(Code code) {
  ModalState& m = state_.modal;
  double tolerance = 0, merge = 0;
  bool merges = true;
  if (code.number == 640) {
    if (!take_if_given('P', tolerance) || !take_if_given('Q', merge)) return false;
    if (tolerance < 0) return fail(block_.column_of('P'), say("the tolerance P of G64 cannot be negative"));
    if (merge < 0) return fail(block_.column_of('Q'), say("the tolerance Q of G64 cannot be negative"));
    const bool given = block_.has('Q');
    merges = !given || merge > 0;
    if (!given) merge = tolerance;
  }
  m.merge_lines = merges;
  m.exact_path = code.number != 640;
  m.path_tolerance_mm = length(tolerance);
  m.merge_tolerance_mm = length(merge);
  emit(canonical::PathMode{m.exact_path, m.path_tolerance_mm, m.merge_tolerance_mm, merges});
  return true;
}

}  // namespace kinebus::gcode
