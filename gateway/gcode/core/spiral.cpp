// Arcs that end on another radius than they began on, as LinuxCNC takes them: programs whose centres are
// rounded. Within the machine's own tolerance they are made round (curves/arc.cpp), beyond it they are
// spirals.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/curves/arc.hpp"
#include "gateway/gcode/curves/curve.hpp"
#include "gateway/gcode/curves/nurbs.hpp"

namespace kinebus::gcode {
namespace {

// LinuxCNC takes radii that differ by two roundings of 0.01 mm or 0.001 inch across the diagonal, and 0.1 %
// up to a hundred times as much.
constexpr double kRounding_mm = 0.0283, kRounding_inch = 0.00283, kMostRoundings = 100;
constexpr double kRelative = 1e-3;
constexpr double kMostChords = 100'000;

}  // namespace

bool Core::is_spiral(const Point2& from, const Point2& to, const Point2& centre) const {
  const ModalState& m = state_.modal;
  if (m.dialect != Dialect::kLinuxCnc && !options_.spindle) return false;
  const double first = length_of(from - centre), last = length_of(to - centre);
  const double off = std::abs(first - last);
  if (off <= options_.arc_radius_tolerance_mm || std::min(first, last) <= options_.arc_radius_tolerance_mm)
    return false;
  const double rounding = m.inches ? kRounding_inch * 25.4 : kRounding_mm;
  return off <= rounding || (off <= kRelative * std::max(first, last) && off <= kMostRoundings * rounding);
}

/// Lines within kSplineFlatness_mm of the spiral; all other axes go along evenly.
bool Core::run_spiral(const Pose& program, const Point2& centre, bool clockwise, int turns) {
  ModalState& m = state_.modal;
  const PlaneAxes plane = plane_axes();
  const Pose start = m.program;
  const Point2 from = Point2{start[plane.u], start[plane.v]} - centre;
  const Point2 to = Point2{program[plane.u], program[plane.v]} - centre;
  const double first = length_of(from), last = length_of(to);
  const double begin = std::atan2(from[1], from[0]);
  double sweep = std::atan2(cross(from, to), dot(from, to)) * (clockwise ? -1 : 1);
  if (sweep <= 0) sweep += 2 * std::numbers::pi;
  sweep += 2 * std::numbers::pi * (turns - 1);
  const double step = std::sqrt(8 * kSplineFlatness_mm / std::max(first, last));
  const double pieces = std::ceil(sweep / step);
  const std::uint32_t column = block_.has(GGroup::kMotion) ? block_.code(GGroup::kMotion).column : 1;
  if (pieces > kMostChords) return fail(column, say("the spline is too large"));
  double feed = 0, time = 0;
  if (!speed_for(false, {m.feed_known, m.feed_mm_per_s, m.feed_rad_per_s}, feed, time)) return false;
  if (m.inverse_time) feed = std::hypot((first + last) / 2 * sweep, program[plane.w] - start[plane.w]) / time;
  const auto count = static_cast<int>(pieces);
  for (int i = 1; i <= count; ++i) {
    const double part = static_cast<double>(i) / count;
    const double radius = first + (last - first) * part;
    const double angle = begin + (clockwise ? -sweep : sweep) * part;
    Pose point = program;
    if (i < count) {
      for (std::size_t axis = 0; axis < point.size(); ++axis)
        point[axis] = start[axis] + (program[axis] - start[axis]) * part;
      point[plane.u] = centre[0] + radius * std::cos(angle);
      point[plane.v] = centre[1] + radius * std::sin(angle);
    }
    const Pose target = canonical_pose(point);
    emit(canonical::Feed{target, m.frame, feed, 0});
    m.position = target;
    m.e_max_mm = std::max(m.e_max_mm, target[kAxisE]);
  }
  m.program = program;
  return true;
}

}  // namespace kinebus::gcode
