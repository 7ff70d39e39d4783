#pragma once
// Forward kinematics of M1's parallel part: where the platform is, for four carriage travels.

#include "gateway/kinematics/tool_placement.hpp"

namespace kinebus {

/// The legs' constants, one array each, so that four legs go through a vector unit together.
struct LegTable {
  explicit LegTable(const M1Geometry& geometry);
  alignas(32) double bx_ax[4];             ///< x does not turn with A: b.x - a.x
  alignas(32) double by[4], bz[4];         ///< b
  alignas(32) double ay[4], az[4];         ///< a
  alignas(32) double dx[4], dy[4], dz[4];  ///< d^, unit length
  alignas(32) double ll[4];                ///< l^2
  alignas(32) double c[4];
  alignas(32) double branch[4];  ///< +1: carriage ahead of the platform along d^
};

/// Solved when every leg closes to this. Rounding leaves about 1e-13.
inline constexpr double kForwardTolerance_mm = 1e-10;

/// Damped Newton (Levenberg) on the four closure equations, from `pose`; on failure, or when it ends on
/// another branch of a leg or beyond the A limits, from further starts in the workspace. Returns the largest
/// leg's closure error in mm; `pose` is the solution when that is below kForwardTolerance_mm, else unchanged.
double solve_platform(const LegTable& legs, const M1Geometry& geometry, const JointVector& joints,
                      PlatformPose& pose);

}  // namespace kinebus
