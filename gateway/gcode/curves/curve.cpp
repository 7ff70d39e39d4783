#include "gateway/gcode/curves/curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinebus::gcode {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
// An angle this little below a full turn is rounding of none.
constexpr double kAngleRounding = 1e-9;

/// How far `point` lies behind the arc's start, from 0 to less than a turn.
double angle_along(const Curve& arc, const Point2& point) {
  const Point2 a = arc.from - arc.centre, b = point - arc.centre;
  double angle = arc.turn * std::atan2(cross(a, b), dot(a, b));
  if (angle < 0) angle += kFullTurn;
  return angle > kFullTurn - kAngleRounding ? 0 : angle;
}

bool reaches(const Curve& arc, const Point2& point) {
  return arc.sweep >= kFullTurn - kAngleRounding || angle_along(arc, point) <= arc.sweep + kAngleRounding;
}

double distance_to(const Curve& curve, const Point2& point) {
  if (!curve.arc) {
    const Point2 d = curve.to - curve.from;
    const double square = dot(d, d);
    const double t = square > 0 ? std::clamp(dot(point - curve.from, d) / square, 0.0, 1.0) : 0;
    return length_of(point - curve.from - d * t);
  }
  if (reaches(curve, point)) return std::abs(length_of(point - curve.centre) - curve.radius);
  return std::min(length_of(point - curve.from), length_of(point - curve.to));
}

bool on_line(const Curve& line, const Point2& point) {
  const Point2 d = line.to - line.from;
  const double t = dot(point - line.from, d);
  return t >= 0 && t <= dot(d, d);
}
Meetings circle_with(const Point2& centre, double radius, const Point2& foot, const Point2& along) {
  Meetings found;
  const double rest = radius * radius - dot(foot - centre, foot - centre);
  if (rest < 0) return found;
  const double half = std::sqrt(rest);
  found.count = 2;
  found.points = {foot + along * half, foot - along * half};
  return found;
}

}  // namespace

bool lies_on(const Curve& curve, const Point2& point) {
  return curve.arc ? reaches(curve, point) : on_line(curve, point);
}

double length_of(const Point2& a) {
  return std::hypot(a[0], a[1]);
}

Point2 direction_at_start(const Curve& curve) {
  if (!curve.arc) return (curve.to - curve.from) * (1 / length_of(curve.to - curve.from));
  return left_of(curve.from - curve.centre) * (curve.turn / curve.radius);
}

Point2 direction_at_end(const Curve& curve) {
  if (!curve.arc) return direction_at_start(curve);
  return left_of(curve.to - curve.centre) * (curve.turn / curve.radius);
}

Curve offset(const Curve& curve, double left_mm) {
  Curve moved = curve;
  if (!curve.arc) {
    const Point2 aside = left_of(direction_at_start(curve)) * left_mm;
    moved.from = curve.from + aside;
    moved.to = curve.to + aside;
    return moved;
  }
  moved.radius = curve.radius - curve.turn * left_mm;
  const double ratio = moved.radius / curve.radius;
  moved.from = curve.centre + (curve.from - curve.centre) * ratio;
  moved.to = curve.centre + (curve.to - curve.centre) * ratio;
  return moved;
}

double distance_along(const Curve& curve, const Point2& point) {
  if (!curve.arc) return dot(point - curve.from, direction_at_start(curve));
  return angle_along(curve, point) * curve.radius;
}

Meetings meetings(const Curve& a, const Curve& b) {
  if (!a.arc && !b.arc) {
    const Point2 d = a.to - a.from, e = b.to - b.from;
    const double area = cross(d, e);
    if (area == 0) return {};
    Meetings found;
    found.count = 1;
    found.points[0] = a.from + d * (cross(b.from - a.from, e) / area);
    return found;
  }
  if (a.arc && b.arc) {
    const Point2 between = b.centre - a.centre;
    const double d = length_of(between);
    if (d == 0) return {};
    const Point2 u = between * (1 / d);
    const double foot = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);
    return circle_with(a.centre, a.radius, a.centre + u * foot, left_of(u));
  }
  const Curve& line = a.arc ? b : a;
  const Curve& arc = a.arc ? a : b;
  const Point2 d = direction_at_start(line);
  return circle_with(arc.centre, arc.radius, line.from + d * dot(arc.centre - line.from, d), d);
}

double distance(const Curve& a, const Curve& b) {
  double least =
      std::min({distance_to(a, b.from), distance_to(a, b.to), distance_to(b, a.from), distance_to(b, a.to)});
  const auto touch = [&](const Point2& on_a, const Curve& other) {
    least = std::min(least, distance_to(other, on_a));
  };
  const Meetings met = meetings(a, b);
  for (std::size_t i = 0; i < static_cast<std::size_t>(met.count); ++i)
    if (lies_on(a, met.points[i]) && lies_on(b, met.points[i])) return 0;
  if (a.arc && b.arc) {
    const Point2 between = b.centre - a.centre;
    const double d = length_of(between);
    if (d == 0) return least;
    for (const double side : {1.0, -1.0}) {
      const Point2 on_a = a.centre + between * (side * a.radius / d);
      if (reaches(a, on_a)) touch(on_a, b);
    }
  } else if (a.arc != b.arc) {
    const Curve& line = a.arc ? b : a;
    const Curve& arc = a.arc ? a : b;
    const Point2 d = direction_at_start(line);
    const Point2 foot = line.from + d * dot(arc.centre - line.from, d);
    if (on_line(line, foot)) touch(foot, arc);
  }
  return least;
}

}  // namespace kinebus::gcode
