#include "gateway/gcode/curves/arc.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "gateway/gcode/curves/curve.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
// Ends nearer than this are one point: 1 nm, far below what a job writes.
constexpr double kSamePoint_mm = 1e-6;
// Moving the centre by more than this many tolerances would bend the arc visibly.
constexpr double kLargestShift = 10;

/// Angle from `from` to `to` in the turn's direction, 0 < angle <= 2 pi.
double swept(Point2 from, Point2 to, bool clockwise) {
  double angle = std::atan2(cross(from, to), dot(from, to));
  if (clockwise) angle = -angle;
  return angle > 0 ? angle : angle + kTurn;
}

std::string millimetres(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.4f mm", value);
  return text.data();
}

}  // namespace

Result<ArcGeometry, Sentence> arc_by_centre(Point2 start, Point2 end, Point2 centre, bool clockwise,
                                            int turns, double tolerance_mm) {
  const double start_radius = length_of(start - centre);
  const double end_radius = length_of(end - centre);
  const double more_turns = kTurn * (turns - 1);
  if (start_radius < kSamePoint_mm) return Error<Sentence>(say("the centre of the arc is its start"));
  if (std::abs(start_radius - end_radius) > tolerance_mm)
    return Error<Sentence>(say("the arc's end is %1 from the centre, its start %2 (they may differ by %3)",
                               millimetres(end_radius), millimetres(start_radius),
                               millimetres(tolerance_mm)));
  const Point2 chord = end - start;
  const double chord_length = length_of(chord);
  if (chord_length < kSamePoint_mm) return ArcGeometry{centre, start, kTurn + more_turns};

  // The centre's offset from the chord's perpendicular bisector, as a fraction of the chord.
  const Point2 middle = {start[0] + chord[0] / 2, start[1] + chord[1] / 2};
  const double shift = dot(middle - centre, chord) / (chord_length * chord_length);
  if (std::abs(shift) * chord_length <= kLargestShift * tolerance_mm) {
    const Point2 moved = {centre[0] + shift * chord[0], centre[1] + shift * chord[1]};
    if (length_of(start - moved) < kSamePoint_mm)
      return Error<Sentence>(say("the centre of the arc is its start"));
    return ArcGeometry{moved, end, swept(start - moved, end - moved, clockwise) + more_turns};
  }
  const double scale = start_radius / end_radius;
  const Point2 on_circle = {centre[0] + (end[0] - centre[0]) * scale,
                            centre[1] + (end[1] - centre[1]) * scale};
  return ArcGeometry{centre, on_circle, swept(start - centre, on_circle - centre, clockwise) + more_turns};
}

Result<ArcGeometry, Sentence> arc_by_radius(Point2 start, Point2 end, double radius_mm, bool clockwise,
                                            int turns, double tolerance_mm) {
  const Point2 chord = end - start;
  const double half = length_of(chord) / 2;
  const double radius = std::abs(radius_mm);
  if (half < kSamePoint_mm / 2)
    return Error<Sentence>(
        say("an arc with R needs an end other than its start; a full circle needs I, J or K"));
  if (radius == 0) return Error<Sentence>(say("R must not be 0"));
  if (half > radius && 2 * half - 2 * radius > tolerance_mm)
    return Error<Sentence>(say("the arc's ends are %1 apart, more than twice R (%2)", millimetres(2 * half),
                               millimetres(radius)));
  const double height = half < radius ? std::sqrt((radius - half) * (radius + half)) : 0;
  // The centre lies left of the chord for a short counterclockwise arc.
  const double side = (radius_mm > 0) == clockwise ? -1 : 1;
  const Point2 left = {-chord[1] / (2 * half), chord[0] / (2 * half)};
  const Point2 centre = {start[0] + chord[0] / 2 + side * height * left[0],
                         start[1] + chord[1] / 2 + side * height * left[1]};
  double sweep = 2 * std::asin(std::min(1.0, half / radius));
  if (radius_mm < 0) sweep = kTurn - sweep;
  return ArcGeometry{centre, end, sweep + kTurn * (turns - 1)};
}

}  // namespace kinebus::gcode
