#pragma once
// Where a point of the turning and tilting table is in the machine frame: m = R_X(A) R_Z(C) q, with both
// derivatives by a path parameter. Exact shortcuts for angles that are zero or at rest, which most moves
// have.

#include <cmath>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus {

/// Sine and cosine of an angle; a zero angle costs nothing.
struct Turn {
  double c = 1, s = 0;
  Turn() = default;
  explicit Turn(double angle_rad) {
    if (angle_rad != 0) {
      c = std::cos(angle_rad);
      s = std::sin(angle_rad);
    }
  }
};

inline Vector3 turn_x(const Turn& t, const Vector3& v) {
  return {v[0], t.c * v[1] - t.s * v[2], t.s * v[1] + t.c * v[2]};
}
inline Vector3 turn_z(const Turn& t, const Vector3& v) {
  return {t.c * v[0] - t.s * v[1], t.s * v[0] + t.c * v[1], v[2]};
}
inline Vector3 turn_back_x(const Turn& t, const Vector3& v) {
  return {v[0], t.c * v[1] + t.s * v[2], -t.s * v[1] + t.c * v[2]};
}
inline Vector3 turn_back_z(const Turn& t, const Vector3& v) {
  return {t.c * v[0] + t.s * v[1], -t.s * v[0] + t.c * v[1], v[2]};
}

/// A point and its first two derivatives by the path parameter.
struct PointPath {
  Vector3 x{}, x1{}, x2{};
};

/// The path of R_X(a) v(s), a and v both moving: v'' gains 2 a' x v' (Coriolis), a'' x v and a' x (a' x v).
inline void turn_path_x(const Turn& t, double a1, double a2, PointPath& p) {
  p.x = turn_x(t, p.x);
  p.x1 = turn_x(t, p.x1);
  p.x2 = turn_x(t, p.x2);
  if (a1 == 0 && a2 == 0) return;
  const double y1 = p.x1[1], z1 = p.x1[2], a11 = a1 * a1;
  p.x1[1] -= a1 * p.x[2];
  p.x1[2] += a1 * p.x[1];
  p.x2[1] += -2 * a1 * z1 - a2 * p.x[2] - a11 * p.x[1];
  p.x2[2] += 2 * a1 * y1 + a2 * p.x[1] - a11 * p.x[2];
}

/// The same about Z.
inline void turn_path_z(const Turn& t, double c1, double c2, PointPath& p) {
  p.x = turn_z(t, p.x);
  p.x1 = turn_z(t, p.x1);
  p.x2 = turn_z(t, p.x2);
  if (c1 == 0 && c2 == 0) return;
  const double x1 = p.x1[0], y1 = p.x1[1], c11 = c1 * c1;
  p.x1[0] -= c1 * p.x[1];
  p.x1[1] += c1 * p.x[0];
  p.x2[0] += -2 * c1 * y1 - c2 * p.x[1] - c11 * p.x[0];
  p.x2[1] += 2 * c1 * x1 + c2 * p.x[0] - c11 * p.x[1];
}

/// Turns by an angle of exactly zero that does not move change nothing and are left out.
inline void part_to_machine(const PosePoint& pose, const Turn& a, PointPath& p) {
  if (pose.x[kC] != 0 || pose.x1[kC] != 0 || pose.x2[kC] != 0)
    turn_path_z(Turn(pose.x[kC]), pose.x1[kC], pose.x2[kC], p);
  if (pose.x[kA] != 0 || pose.x1[kA] != 0 || pose.x2[kA] != 0) turn_path_x(a, pose.x1[kA], pose.x2[kA], p);
}

}  // namespace kinebus
