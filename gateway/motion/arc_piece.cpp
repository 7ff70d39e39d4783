#include "gateway/motion/arc_piece.hpp"

#include <cmath>

namespace kinebus {
namespace {

using Vector3 = std::array<double, 3>;

double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

bool shape_arc(const canonical::Arc& arc, const Pose& from, Move& move) {
  const double normal_length = std::sqrt(dot(arc.normal, arc.normal));
  if (!(normal_length > 0.5) || !(arc.sweep_rad > 0)) return false;
  Vector3 n, radial, radial_end;
  for (std::size_t i = 0; i < 3; ++i) n[i] = arc.normal[i] / normal_length;
  for (std::size_t i = 0; i < 3; ++i) {
    radial[i] = from[i] - arc.centre_mm[i];
    radial_end[i] = arc.target[i] - arc.centre_mm[i];
  }
  const double base = dot(radial, n), base_end = dot(radial_end, n);
  for (std::size_t i = 0; i < 3; ++i) {
    radial[i] -= base * n[i];
    radial_end[i] -= base_end * n[i];
  }
  const double radius = std::sqrt(dot(radial, radial)), radius_end = std::sqrt(dot(radial_end, radial_end));
  if (!(radius > 1e-6)) return false;
  // The interpreter has its own, tighter rule on the radii; this one only keeps nonsense out of the planner.
  if (std::abs(radius - radius_end) > 0.5 && std::abs(radius - radius_end) > 0.02 * radius) return false;

  ArcShape& shape = move.shape;
  shape.radius_mm = radius;
  for (std::size_t i = 0; i < 3; ++i) {
    shape.u[i] = radial[i] / radius;
    shape.centre[i] = from[i] - radial[i];
  }
  shape.v = cross(n, shape.u);
  const double flat = radius * arc.sweep_rad;
  move.length = std::sqrt(flat * flat + (base_end - base) * (base_end - base));
  shape.w_rad_per_mm = arc.sweep_rad / move.length;
  const double cosine = std::cos(arc.sweep_rad), sine = std::sin(arc.sweep_rad);
  for (std::size_t i = 0; i < 3; ++i) {
    const double end = shape.centre[i] + radius * (shape.u[i] * cosine + shape.v[i] * sine);
    shape.slope[i] = (arc.target[i] - end) / move.length;
  }
  move.arc = true;
  for (std::size_t i = 3; i < kPoseAxes; ++i) move.u[i] = (arc.target[i] - from[i]) / move.length;
  const PosePoint start = point_on(move, 0), end = point_on(move, move.length);
  move.u = start.x1;
  move.u_end = end.x1;
  return std::isfinite(move.length);
}

void arc_piece(const Move& move, double from, double to, PathPiece& piece) {
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    if (i < 3) {
      piece.coefficients[i] = {move.shape.centre[i] + move.shape.slope[i] * from, move.shape.slope[i], 0, 0};
    } else {
      piece.coefficients[i] = {move.from[i] + move.u[i] * from, move.u[i], 0, 0};
    }
  }
  piece.arc = true;
  piece.radius_mm = move.shape.radius_mm;
  piece.angle0_rad = move.shape.w_rad_per_mm * from;
  piece.angle1_rad_per_mm = move.shape.w_rad_per_mm;
  piece.u = move.shape.u;
  piece.v = move.shape.v;
  piece.length = to - from;
  piece.frame = move.frame;
}

PosePoint point_on(const Move& move, double s) {
  if (move.arc) {
    PathPiece piece;
    arc_piece(move, 0, move.length, piece);
    return piece.evaluate(s);
  }
  PosePoint p;
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    p.x[i] = move.from[i] + move.u[i] * s;
    p.x1[i] = move.u[i];
  }
  return p;
}

}  // namespace kinebus
