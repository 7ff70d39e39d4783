// Polar coordinates in X and Y: @ the distance from the zero point, ^ the angle in degrees (LinuxCNC).

#include <cmath>
#include <numbers>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {

/// Puts X and Y into the block that mean the same. Under G91 both count from where the tool stands, still as
/// distance and angle about the zero point.
bool Core::polar_words() {
  const ModalState& m = state_.modal;
  const std::uint32_t column = block_.polar_column;
  if (block_.has('X') || block_.has('Y')) return fail(column, say("@ and ^ cannot stand beside X and Y"));
  if (block_.has(GGroup::kNonmodal) && block_.code(GGroup::kNonmodal).number != 40)
    return fail(column, say("@ and ^ cannot stand beside %1", g_name(block_.code(GGroup::kNonmodal).number)));
  if (m.plane != Plane::kXy) return fail(column, say("@ and ^ need the plane of X and Y (G17)"));
  const double x = m.program[kAxisX], y = m.program[kAxisY];
  const double radius = std::hypot(x, y), angle = std::atan2(y, x);
  const double given_radius = length(block_.polar_radius.value_or(0));
  const double given_angle = block_.polar_angle.value_or(0) * (std::numbers::pi / 180);
  if (m.incremental && radius < kNoMotion)
    return fail(column, say("under G91 @ and ^ cannot start at the zero point, where there is no angle"));
  polar_step_ = {given_radius, given_angle};
  const double to_radius = m.incremental         ? radius + given_radius
                           : block_.polar_radius ? given_radius
                                                 : radius;
  const double to_angle = m.incremental ? angle + given_angle : block_.polar_angle ? given_angle : angle;
  const double unit = m.inches ? 25.4 : 1;
  const std::array<double, 2> to = {to_radius * std::cos(to_angle), to_radius * std::sin(to_angle)};
  const std::array<double, 2> from = {x, y};
  for (std::size_t axis = kAxisX; axis <= kAxisY; ++axis) {
    const std::size_t at = Block::index(kAxisLetters[axis]);
    block_.value[at] = (m.incremental ? to[axis] - from[axis] : to[axis]) / unit;
    block_.column[at] = column;
    block_.present |= Block::bit(kAxisLetters[axis]);
  }
  return true;
}

}  // namespace kinebus::gcode
