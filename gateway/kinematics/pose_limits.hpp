#pragma once
// Checks that several kinematics share.

#include <cmath>
#include <optional>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus {

/// How far `value` is outside, > 0; 0: inside or not limited. Not a number is infinitely far outside.
inline double outside(const Interval& interval, double value) {
  // Rounding in q(forward(q)) must not turn a joint that stands on its limit into an error: 1 nm, 1 nrad.
  constexpr double kSlack = 1e-6;
  if (!std::isfinite(value)) return HUGE_VAL;
  if (!interval.limited()) return 0;
  const double d = value < interval.min ? interval.min - value : value - interval.max;
  return d > kSlack ? d : 0;
}

inline std::optional<PoseError> outside_error(PoseError::Kind kind, int index, const Interval& interval,
                                              double value, bool angular) {
  const double by = outside(interval, value);
  if (by > 0) return PoseError{kind, index, by, angular};
  return std::nullopt;
}

/// `q`: table coordinates.
inline std::optional<PoseError> check_pose_limits(const PoseLimits& limits, const Vector3& q, double a_rad,
                                                  double c_rad) {
  using Kind = PoseError::Kind;
  if (auto e = outside_error(Kind::kPoseLimit, kX, limits.x_mm, q[0], false)) return e;
  if (auto e = outside_error(Kind::kPoseLimit, kY, limits.y_mm, q[1], false)) return e;
  if (auto e = outside_error(Kind::kPoseLimit, kZ, limits.z_mm, q[2], false)) return e;
  if (auto e = outside_error(Kind::kPoseLimit, kA, limits.a_rad, a_rad, true)) return e;
  if (auto e = outside_error(Kind::kPoseLimit, kC, limits.c_rad, c_rad, true)) return e;
  // The root is needed for the message only; not a number goes that way too.
  if (limits.radius_mm > 0 && !(q[0] * q[0] + q[1] * q[1] <= limits.radius_mm * limits.radius_mm)) {
    const double radius = std::hypot(q[0], q[1]);
    const int axis = std::abs(q[0]) >= std::abs(q[1]) ? kX : kY;
    if (auto e = outside_error(Kind::kPoseLimit, axis, {0, limits.radius_mm}, radius, false)) return e;
  }
  return std::nullopt;
}

/// A machine without a table stands at A = C = 0 only.
inline std::optional<PoseError> check_no_rotation(const Pose& pose) {
  for (const PoseAxis axis : {kA, kC})
    if (pose[axis] != 0) return PoseError{PoseError::Kind::kPoseLimit, axis, std::abs(pose[axis]), true};
  return std::nullopt;
}

/// Row `row` of a Jacobian with kPoseAxes columns.
inline std::span<double> jacobian_row(std::span<double> matrix, std::size_t row) {
  return matrix.subspan(row * kPoseAxes, kPoseAxes);
}

/// Condition number (largest over smallest singular value) of an n x n row-major matrix, n <= 4; infinite if
/// singular.
double condition_number(const double* matrix, int n);

/// The same, without singular values, for a 4 x 4 matrix: true when it is at most `most`; false says nothing
/// when it is more than that less 9 %.
bool condition_is_within_4(const double* matrix, double most);

}  // namespace kinebus
