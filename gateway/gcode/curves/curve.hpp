#pragma once
// Lines and arcs in a plane (u, v), where counterclockwise is from u to v: offsets, meeting points,
// distances.

#include <array>
#include <cstdint>

#include "gateway/gcode/curves/arc.hpp"

namespace kinebus::gcode {

/// A straight line, or an arc of any number of turns. Lengths mm, angles rad.
struct Curve {
  Point2 from{}, to{};
  bool arc = false;
  int turn = 1;  ///< 1: counterclockwise
  Point2 centre{};
  double radius = 0;
  double sweep = 0;  ///< > 0
};

inline Point2 operator+(const Point2& a, const Point2& b) {
  return {a[0] + b[0], a[1] + b[1]};
}
inline Point2 operator-(const Point2& a, const Point2& b) {
  return {a[0] - b[0], a[1] - b[1]};
}
inline Point2 operator*(const Point2& a, double k) {
  return {a[0] * k, a[1] * k};
}
inline double dot(const Point2& a, const Point2& b) {
  return a[0] * b[0] + a[1] * b[1];
}
/// > 0: b lies to the left of a.
inline double cross(const Point2& a, const Point2& b) {
  return a[0] * b[1] - a[1] * b[0];
}
inline Point2 left_of(const Point2& a) {
  return {-a[1], a[0]};
}
double length_of(const Point2& a);

/// Unit vectors along the curve at its ends.
Point2 direction_at_start(const Curve& curve);
Point2 direction_at_end(const Curve& curve);

/// The curve at `left_mm` to its left (< 0: right). An arc's radius becomes 0 or less where it does not fit.
Curve offset(const Curve& curve, double left_mm);

/// How far from its start the curve comes by `point`, which lies on it or on what continues it: mm; along an
/// arc from 0 to less than a turn.
double distance_along(const Curve& curve, const Point2& point);

struct Meetings {
  int count = 0;
  std::array<Point2, 2> points{};
};
/// Where the curves, continued as whole lines and circles, meet. Parallel lines do not.
Meetings meetings(const Curve& a, const Curve& b);

/// Whether a point of the continued curve is one of the curve itself.
bool lies_on(const Curve& curve, const Point2& point);

/// The least distance between two curves.
double distance(const Curve& a, const Curve& b);

}  // namespace kinebus::gcode
