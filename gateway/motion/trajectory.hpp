#pragma once
// The planner's output: pose(tau) as a chain of phases. Each phase is a piece of path, traversed with one
// constant path acceleration, or, where jerk is limited, with one constant path jerk. Position and velocity
// are continuous from phase to phase (no velocity step anywhere).

#include <array>
#include <cstdint>

#include "gateway/kinematics/kinematics.hpp"

namespace kinebus {

/// A piece of path, as a function of its parameter s (mm, close to arc length; for moves without tool motion
/// the dominant axis' own unit). Polynomial of degree <= 3 on every pose axis; plus, for arcs, a circle in
/// the plane (u, v) that replaces nothing but adds to X Y Z: radius * (u cos(angle) + v sin(angle)), angle =
/// angle0 + s * angle1.
struct PathPiece {
  std::array<std::array<double, 4>, kPoseAxes> coefficients{};  ///< [axis][power of s]
  bool arc = false;
  double radius_mm = 0, angle0_rad = 0, angle1_rad_per_mm = 0;
  std::array<double, 3> u{}, v{};
  double length = 0;  ///< s runs 0..length
  Frame frame = Frame::kPart;

  /// x(s), dx/ds, d2x/ds2.
  PosePoint evaluate(double s) const;
  /// d3x/ds3, X Y Z.
  std::array<double, 3> third_derivative(double s) const;
};

/// Parameter law of a phase: s(t) = s0 + v0 t + a t^2 / 2 + jerk t^3 / 6, t = 0..duration.
/// A timed phase's parameter is the time for which it was planned, s; v0 is 1 there.
struct Phase {
  PathPiece piece;
  double s0 = 0, v0 = 0, a = 0, jerk = 0;
  double duration_s = 0;
  std::uint32_t line = 0;  ///< the job's line whose motion this is (a blend or a merged curve: the last one)
  bool last = false;       ///< the run ends at rest with this phase
  bool timed = false;

  double s(double t) const { return s0 + t * (v0 + (0.5 * a + jerk * t * (1.0 / 6)) * t); }
  double speed(double t) const { return v0 + (a + 0.5 * jerk * t) * t; }
  double accel(double t) const { return a + jerk * t; }
  /// Pose and its derivatives by time at t seconds after the phase's start.
  PosePoint at(double t) const;
  /// How fast the pose changes at t: by the path's parameter, or of a timed phase by its fastest axis.
  double pose_speed(double t) const;
};

/// Time into `phase` at which its path parameter is `s`.
double time_at(const Phase& phase, double s);

}  // namespace kinebus
