#include "gateway/motion/corner_blend.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/motion/arc_piece.hpp"

namespace kinebus {
namespace {

// Directions closer than this are one: the velocity step left is 0.3 nm/s at 300 mm/s.
constexpr double kSameDirection = 1e-12;
// Two millimetres of blend are enough at any angle: from 5 um of tolerance they result at 0.6 degrees, where
// the corner's acceleration at 300 mm/s is already far below any limit.
constexpr double kLongestHalf_mm = 2.0;
// Shares of the tolerance next to an arc: the kink's deviation, and the arc's own bend within the cubic.
constexpr double kKinkShare = 0.7;
constexpr double kBendShare = 0.2;

}  // namespace

double rotation_tolerance_rad(Frame frame, const Pose& pose, double tolerance_mm,
                              const MotionLimits& limits) {
  if (frame == Frame::kPart) return limits.blend_tolerance_rad;
  // Two rotations add up to sqrt(2) of one at most when they are perpendicular.
  return std::min(limits.blend_tolerance_rad, 0.7 * tolerance_mm / std::max(norm_xyz(pose), 10.0));
}

double blend_half_length(const Move& before, const Move& after, const MotionLimits& limits) {
  const double tolerance = std::min(before.tolerance_mm, after.tolerance_mm);
  Pose du;
  for (std::size_t i = 0; i < kPoseAxes; ++i) du[i] = after.u[i] - before.u_end[i];
  const double bend = norm_xyz(du);
  const double rotation = std::max(std::abs(du[kA]), std::abs(du[kC]));
  const double filament = std::abs(du[kE]);
  if (std::max({bend, rotation, filament}) < kSameDirection) return 0;

  double half = std::min({0.5 * before.length, 0.5 * after.length, kLongestHalf_mm});
  const bool arc = before.arc || after.arc;
  // A parabola passes the corner at bend * half / 4, an even blend at bend * half / 6.
  const double per_deviation = !arc && limits.limits_jerk() ? 6 : 4;
  half = std::min(half, (arc ? kKinkShare : 1.0) * per_deviation * tolerance / std::max(bend, 1e-15));
  if (rotation > 0) {
    half = std::min(
        half, per_deviation * rotation_tolerance_rad(after.frame, after.from, tolerance, limits) / rotation);
  }
  if (filament > 0) half = std::min(half, per_deviation * limits.blend_tolerance_e_mm / filament);
  for (const Move* move : {&before, &after}) {
    // The tangent, instead of the arc, is off by b^2 / 2R at the far end, a quarter of it within the cubic.
    if (move->arc) half = std::min(half, std::sqrt(8 * kBendShare * tolerance * move->shape.radius_mm));
  }
  return half;
}

void hermite_piece(const Pose& x0, const Pose& u0, const Pose& x1, const Pose& u1, double length,
                   PathPiece& piece) {
  const double inverse = 1 / length;
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    const double slope = (x1[i] - x0[i]) * inverse;
    piece.coefficients[i] = {x0[i], u0[i], (3 * slope - 2 * u0[i] - u1[i]) * inverse,
                             (u0[i] + u1[i] - 2 * slope) * inverse * inverse};
  }
  piece.arc = false;
  piece.length = length;
}

void blend_piece(const Move& before, const Move& after, double half_length, PathPiece& piece) {
  piece.frame = after.frame;
  if (before.arc || after.arc) {
    const PosePoint start = point_on(before, before.length - half_length);
    const PosePoint end = point_on(after, half_length);
    hermite_piece(start.x, start.x1, end.x, end.x1, 2 * half_length, piece);
    return;
  }
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    piece.coefficients[i] = {after.from[i] - before.u[i] * half_length, before.u[i],
                             (after.u[i] - before.u[i]) / (4 * half_length), 0};
  }
  piece.arc = false;
  piece.length = 2 * half_length;
}

void even_blend_piece(const Move& before, const Move& after, double half_length, bool second,
                      PathPiece& piece) {
  const double h = half_length;
  piece.frame = after.frame;
  piece.arc = false;
  piece.length = h;
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    const double du = after.u[i] - before.u[i];
    if (second)
      piece.coefficients[i] = {after.from[i] + du * h / 6, before.u[i] + 0.5 * du, du / (2 * h),
                               -du / (6 * h * h)};
    else
      piece.coefficients[i] = {after.from[i] - before.u[i] * h, before.u[i], 0, du / (6 * h * h)};
  }
}

}  // namespace kinebus
