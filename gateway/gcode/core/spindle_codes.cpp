// The spindle: M3, M4, M5, S, G96 and G97.

#include <cmath>
#include <numbers>
#include <utility>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {
namespace {

// A smaller change of speed is not worth the wait for it.
constexpr double kLeastChange = 0.001;

}  // namespace

bool Core::spindle(Code code) {
  if (!options_.spindle) return code.number == 5 || fail(code.column, unknown_m(code.number));
  ModalState& m = state_.modal;
  if (code.number == 5) {
    m.spindle_turns = 0;
    emit(canonical::Spindle{0});
    return true;
  }
  m.spindle_turns = code.number == 3 ? 1 : -1;
  if (has('S')) return spindle_speed();
  if (!(m.surface_speed ? m.surface_m_per_min > 0 : m.spindle_rpm > 0))
    return fail(code.column, say("%1 needs a speed S", m_name(code.number)));
  if (m.surface_speed) m.spindle_rpm = surface_rpm();
  emit(canonical::Spindle{m.spindle_turns * m.spindle_rpm});
  return true;
}

bool Core::spindle_mode() {
  const Code code = block_.code(GGroup::kSpindleMode);
  ModalState& m = state_.modal;
  if (code.number == 970) {
    m.surface_speed = false;
    return true;
  }
  if (!options_.spindle)
    return fail(code.column,
                say("constant surface speed (G96) needs a spindle, which this machine does not have"));
  if (!has('S')) return fail(code.column, say("G96 needs S, the surface speed"));
  double most = 0;
  const bool given = has('D');
  if (!take_if_given('D', most)) return false;
  if (given && !(most > 0))
    return fail(block_.column_of('D'), say("the highest speed D of G96 must be greater than 0"));
  m.surface_speed = true;
  m.surface_most_rpm = most;
  return true;
}

double Core::surface_rpm() const {
  const ModalState& m = state_.modal;
  const double around_m = 2 * std::numbers::pi * std::abs(m.program[kAxisX]) / 1000;
  double rpm = around_m > 0 ? m.surface_m_per_min / around_m : HUGE_VAL;
  if (options_.spindle_min_rpm > 0 && m.surface_m_per_min > 0) rpm = std::fmax(rpm, options_.spindle_min_rpm);
  if (options_.spindle_max_rpm > 0) rpm = std::fmin(rpm, options_.spindle_max_rpm);
  if (m.surface_most_rpm > 0) rpm = std::fmin(rpm, m.surface_most_rpm);
  return std::isfinite(rpm) ? rpm : 0;
}

/// `now`: else only a change that is worth it, behind a traverse.
void Core::follow_surface(bool now) {
  ModalState& m = state_.modal;
  if (!m.surface_speed || (!now && m.motion != Motion::kTraverse)) return;
  const double rpm = surface_rpm();
  if (!now && std::abs(rpm - m.spindle_rpm) <= kLeastChange * m.spindle_rpm) return;
  if (m.feed_per_turn && m.feed_known && m.spindle_rpm > 0) {
    m.feed_mm_per_s *= rpm / m.spindle_rpm;
    m.feed_rad_per_s *= rpm / m.spindle_rpm;
  }
  m.spindle_rpm = rpm;
  if (m.spindle_turns != 0) emit(canonical::Spindle{m.spindle_turns * rpm});
}

void Core::tell_feed_per_turn() {
  if (!options_.spindle_encoder) return;
  ModalState& m = state_.modal;
  const double rpm = m.feed_per_turn && m.spindle_turns != 0 ? m.spindle_rpm : 0;
  if (std::exchange(m.per_turn_rpm, rpm) != rpm) emit(canonical::FeedPerTurn{rpm});
}

bool Core::spindle_speed() {
  if (!options_.spindle || !has('S') || (used_ & Block::bit('S')) != 0) return true;
  double speed = 0;
  if (!take('S', speed)) return false;
  if (!(speed >= 0)) return fail(block_.column_of('S'), say("the spindle's speed S cannot be below 0"));
  ModalState& m = state_.modal;
  if (m.surface_speed) {
    constexpr double kMetresInFoot = 0.3048;
    m.surface_m_per_min = m.inches ? speed * kMetresInFoot : speed;
    follow_surface(true);
    return true;
  }
  if (m.feed_per_turn && m.feed_known && !has('F') && (block_.present & Block::bit('F')) == 0) {
    if (speed > 0 && m.spindle_rpm > 0) {
      m.feed_mm_per_s *= speed / m.spindle_rpm;
      m.feed_rad_per_s *= speed / m.spindle_rpm;
    } else {
      m.feed_known = false;
    }
  }
  m.spindle_rpm = speed;
  if (m.spindle_turns != 0) emit(canonical::Spindle{m.spindle_turns * speed});
  return true;
}

}  // namespace kinebus::gcode
