// Canned cycles: G73, G74 and G81 to G89 with G98 and G99 (RS274/NGC 3.5.16), in every plane.

#include <algorithm>
#include <cmath>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {
namespace {

// How far a drill goes back to break the chip, and how far above the ground of the hole feed begins again:
// RS274/NGC has 0.010 inch.
constexpr double kPeckClearance_mm = 0.254;
// A hole is some pecks deep; more are a slip of the decimal point.
constexpr double kMaxPecks = 1000;

bool uses_dwell(int cycle) {
  return cycle == 820 || cycle == 860 || cycle == 890 || cycle == 840 || cycle == 740;
}
bool uses_peck(int cycle) {
  return cycle == 830 || cycle == 730;
}
bool feeds_out(int cycle) {
  return cycle == 850 || cycle == 890 || cycle == 840 || cycle == 740;
}

}  // namespace

canonical::PathMode Core::path_mode() const {
  const ModalState& m = state_.modal;
  return {m.exact_path, m.path_tolerance_mm, m.merge_tolerance_mm, m.merge_lines};
}

bool Core::cycle_words(Code code, bool fresh) {
  ModalState& m = state_.modal;
  const PlaneAxes plane = plane_axes();
  const char down = kAxisLetters[plane.w];
  const std::string name = g_name(code.number);
  double value = 0;
  if (fresh && !has(down)) return fail(code.column, say("%1 needs %2, the bottom of the hole", name, down));
  if (fresh && !has('R')) return fail(code.column, say("%1 needs R, where the feed begins", name));
  if (fresh && uses_peck(code.number) && !has('Q'))
    return fail(code.column, say("%1 needs Q, the depth of a peck", name));
  if (has(down)) {
    if (!take(down, value)) return false;
    m.cycle_bottom_mm = length(value);
  }
  if (has('R')) {
    if (!take('R', value)) return false;
    m.cycle_r_mm = length(value);
  }
  if (uses_peck(code.number) && has('Q')) {
    if (!take('Q', value)) return false;
    if (!(value > 0)) return fail(block_.column_of('Q'), say("the depth of a peck Q must be greater than 0"));
    m.cycle_peck_mm = length(value);
  }
  if (uses_dwell(code.number) && has('P')) {
    if (!take('P', value)) return false;
    if (value < 0) return fail(block_.column_of('P'), say("G4 cannot wait for a negative time"));
    m.cycle_dwell_s = dwell_s(value);
  } else if (fresh) {
    m.cycle_dwell_s = 0;
  }
  for (const char letter : {'A', 'C', 'E'})
    if (has(letter)) return fail(block_.column_of(letter), say("%1 has no place in a canned cycle", letter));
  return true;
}

bool Core::run_cycle() {
  ModalState& m = state_.modal;
  const bool named = block_.has(GGroup::kMotion);
  const Code code = named ? block_.code(GGroup::kMotion) : Code{m.cycle, 1};
  const PlaneAxes plane = plane_axes();
  const bool fresh = code.number != m.cycle;
  if (!named && !has('X') && !has('Y') && !has('Z')) return true;
  if (m.inverse_time) return fail(code.column, say("a canned cycle needs feed per minute (G94)"));
  if (!m.feed_known) return fail(code.column, say("no feed rate is set: this move needs F"));
  const bool spindle_acts = code.number == 840 || code.number == 740 || code.number == 860;
  if (spindle_acts && m.spindle_turns != (code.number == 740 ? -1 : 1) &&
      !(code.number == 860 && m.spindle_turns == -1))
    return fail(code.column, say("%1 needs the spindle to turn (%2)", g_name(code.number),
                                 code.number == 740 ? "M4" : "M3"));
  if (m.cycle == 0) m.cycle_initial_mm = m.program[plane.w];
  if (!cycle_words(code, fresh)) return false;
  m.cycle = code.number;
  m.motion = Motion::kNone;
  int times = 1;
  if (!take_integer('L', 0, 10000, times)) return false;

  double steps[2] = {0, 0};  // along u, v: of each repetition
  Vector3 point = xyz(m.program);
  std::size_t at = 0;
  for (const std::size_t axis : {plane.u, plane.v}) {
    const char letter = kAxisLetters[axis];
    double value = 0;
    if (has(letter)) {
      if (!take(letter, value)) return false;
      if (m.incremental)
        steps[at] = length(value);
      else
        point[axis] = length(value);
    }
    ++at;
  }
  // From where the row began, wherever the hole before has left the tool: with G99 that is R.
  const double r = m.incremental ? m.cycle_initial_mm + m.cycle_r_mm : m.cycle_r_mm;
  const double bottom = m.incremental ? r + m.cycle_bottom_mm : m.cycle_bottom_mm;
  if (bottom > r)
    return fail(code.column,
                say("the bottom of the hole lies above R: %1 goes from R down", g_name(code.number)));
  if (uses_peck(code.number) && (r - bottom) / m.cycle_peck_mm * times > kMaxPecks * 10)
    return fail(code.column, say("the depth of a peck Q is far too small for this hole"));
  const double clear = m.retract_to_r ? r : std::max(r, m.cycle_initial_mm);
  if (times == 0) return true;

  const bool exact = m.exact_path;
  if (!exact) emit(canonical::PathMode{true, 0, 0, true});
  Vector3 here = xyz(m.program);
  if (here[plane.w] < r) {
    here[plane.w] = r;
    if (!cycle_move(here, true)) return false;
  }
  const bool polar = has_polar() && m.incremental;
  for (int i = 0; i < times; ++i) {
    if (polar) {
      const double radius = std::hypot(point[kAxisX], point[kAxisY]) + polar_step_[0];
      const double angle = std::atan2(point[kAxisY], point[kAxisX]) + polar_step_[1];
      steps[0] = radius * std::cos(angle) - point[kAxisX];
      steps[1] = radius * std::sin(angle) - point[kAxisY];
    }
    point[plane.u] += steps[0];
    point[plane.v] += steps[1];
    point[plane.w] = m.program[plane.w];
    if (!cycle_move(point, true)) return false;
    point[plane.w] = r;
    if (!cycle_move(point, true)) return false;
    if (!drill(plane.w, r, bottom, clear)) return false;
  }
  if (!exact) emit(path_mode());
  return true;
}

bool Core::drill(std::size_t w, double r, double bottom, double clear) {
  const ModalState& m = state_.modal;
  Vector3 point = xyz(m.program);
  const auto go = [&](double to, bool traverse) {
    point[w] = to;
    return cycle_move(point, traverse);
  };
  if (uses_peck(m.cycle)) {
    const auto pecks = static_cast<int>(std::ceil((r - bottom) / m.cycle_peck_mm - 1e-9));
    for (int i = 1; i < pecks; ++i) {
      const double depth = r - i * m.cycle_peck_mm;
      if (!go(depth, false)) return false;
      if (!go(m.cycle == 830 ? r : std::min(r, depth + kPeckClearance_mm), true)) return false;
      if (m.cycle == 830 && !go(std::min(r, depth + kPeckClearance_mm), true)) return false;
    }
  }
  const double rpm = m.spindle_turns * m.spindle_rpm;
  if ((m.cycle == 840 || m.cycle == 740) && taps_rigidly()) {
    Vector3 ground = point, above = point;
    ground[w] = bottom;
    above[w] = clear;
    return bottom == r || tap(ground, above, m.feed_mm_per_s * 60 / m.spindle_rpm);
  }
  if (!go(bottom, false)) return false;
  if (uses_dwell(m.cycle) && m.cycle_dwell_s > 0) emit(canonical::Dwell{m.cycle_dwell_s});
  if (m.cycle == 860) emit(canonical::Spindle{0});
  if (m.cycle == 840 || m.cycle == 740) emit(canonical::Spindle{-rpm});
  if (feeds_out(m.cycle) && !go(clear, false)) return false;
  if (m.cycle == 840 || m.cycle == 740) emit(canonical::Spindle{rpm});
  if (!go(clear, true)) return false;
  if (m.cycle == 860) emit(canonical::Spindle{rpm});
  return true;
}

bool Core::cycle_move(const Vector3& program, bool traverse) {
  ModalState& m = state_.modal;
  Pose wanted = m.program;
  set_xyz(wanted, program);
  Pose target = m.position;
  set_xyz(target, to_canonical_xyz(program));
  m.program = wanted;
  if (norm(xyz(target) - xyz(m.position)) <= kNoMotion) return true;
  m.position = target;
  if (traverse)
    emit(canonical::Traverse{target, m.frame, 0});
  else
    emit(canonical::Feed{target, m.frame, m.feed_mm_per_s * m.feed_ratio, 0});
  return true;
}

}  // namespace kinebus::gcode
