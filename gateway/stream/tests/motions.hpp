#pragma once
// Motions to stream, as a planner makes them: printed lines with blended corners, the same with limited jerk,
// and smooth curves in cubic pieces.

#include <cstdint>
#include <vector>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/joint_span.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus::testing {

struct PrintedLines {
  int lines = 100;
  double mean_length_mm = 5;
  double speed_mm_per_s = 60;
  double accel_mm_per_s2 = 2900;
  double blend_mm = 0.005;
  double extrusion = 0.04;  ///< mm of filament for a mm of line, on average
  double radius_mm = 60;    ///< all lines stay within
};
/// Lines in random directions at z = 10 mm; rest to rest, the last phase marked.
std::vector<Phase> printed_lines(std::uint32_t seed, const PrintedLines& shape);

/// Such lines as the planner plans them under a limit of jerk.
std::vector<Phase> eased_lines(const Kinematics& kinematics, std::uint32_t seed, const PrintedLines& shape,
                               double jerk_mm_per_s3);

struct SmoothCurve {
  double seconds = 5;
  double speed_mm_per_s = 100;
  double accel_mm_per_s2 = 2000;  ///< along the path, at both ends
  double piece_mm = 4;
  double radius_mm = 40;
  double tilt_rad = 0;  ///< A swings between +- this
  double turn_rad = 0;  ///< C swings between +- this
};
/// A curve of sine waves, as cubic pieces with common tangents.
std::vector<Phase> smooth_curve(std::uint32_t seed, const SmoothCurve& shape);

/// One joint along a straight axis: accelerate, cruise, decelerate.
std::vector<JointSpan> trapezoid_spans(double accel, double speed, double cruise_s);

/// Two joints, with random lengths and accelerations: jumps everywhere, some spans far shorter than a knot
/// can follow; the last one comes to rest.
std::vector<JointSpan> jumpy_spans(std::uint32_t seed, double accel, int count, double shortest_s = 0.0001,
                                   double longest_s = 0.05);

}  // namespace kinebus::testing
