#pragma once
// What the planner may ask of the machine. Plain numbers; units are in the names (per_s: mm/s or rad/s, by
// axis).

#include <array>
#include <limits>

#include "gateway/kinematics/kinematics.hpp"

namespace kinebus {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Half of the shortest segment on the wire, within which its acceleration is constant anyway.
inline constexpr double kCurvatureJump_s = 0.5e-3;

/// What filament may do besides the machine's limits, so that what is added to it later has room.
struct FilamentLimits {
  double speed_mm_per_s = kUnlimited, accel_mm_per_s2 = kUnlimited;
  double flow_accel_mm_per_s2 = kUnlimited;  ///< while the tool moves
  double flow_jerk_mm_per_s3 = kUnlimited;   ///< the same; where jerk is limited
  /// The path rests where the tool begins or ceases to move along with filament.
  bool rests = false;
  friend bool operator==(const FilamentLimits&, const FilamentLimits&) = default;
};

/// Defaults: machine M1 (four carriages, table C, extruder E as joints 0..5). Every value is > 0.
struct MotionLimits {
  /// Tool tip relative to the frame of the move: length of its velocity and of its acceleration vector.
  double tool_speed_mm_per_s = 300;
  double tool_accel_mm_per_s2 = 3000;
  /// Infinite: none. Where the path's curvature jumps (an arc that begins on a tangent), the acceleration may
  /// jump by what this makes in kCurvatureJump_s.
  double tool_jerk_mm_per_s3 = kUnlimited;
  /// Tool speed of a traverse (G0), when it is below tool_speed_mm_per_s.
  double traverse_mm_per_s = kUnlimited;
  /// Each pose axis by itself, X Y Z A C E. X Y Z are usually limited by the tool and the joints alone.
  Pose axis_speed_per_s{kUnlimited, kUnlimited, kUnlimited, 1.5707963267948966, 6.283185307179586, 60};
  Pose axis_accel_per_s2{kUnlimited, kUnlimited, kUnlimited, 31.41592653589793, 62.83185307179586, 3000};
  /// E while the tool moves, too: what pressure advance adds to it grows with it.
  double flow_accel_mm_per_s2 = kUnlimited;
  double flow_jerk_mm_per_s3 = kUnlimited;  ///< where jerk is limited
  /// Each joint, in the kinematics' order; both terms of q'' count.
  JointVector joint_speed_per_s{450, 450, 450, 450, 6.283185307179586, 60, kUnlimited, kUnlimited};
  JointVector joint_accel_per_s2{5000, 5000, 5000, 5000, 62.83185307179586, 3000, kUnlimited, kUnlimited};

  /// The same, of all terms of q'''. Only where the tool's jerk is limited.
  JointVector joint_jerk_per_s3{kUnlimited, kUnlimited, kUnlimited, kUnlimited,
                                kUnlimited, kUnlimited, kUnlimited, kUnlimited};
  bool limits_jerk() const { return tool_jerk_mm_per_s3 < kUnlimited; }

  /// G64 without P: how far the planned path may leave the programmed one (X Y Z, distance).
  double blend_tolerance_mm = 0.005;
  /// G64 without P and Q: how far a smooth curve through many short lines may leave them; 0: no such curves.
  double merge_tolerance_mm = 0.005;
  /// The same for filament at the nozzle, and for the rotations under tool-centre-point control (where they
  /// do not move the tip). In Frame::kMachine the rotations' own tolerance is what moves the tip by the blend
  /// tolerance.
  double blend_tolerance_e_mm = 0.02;
  double blend_tolerance_rad = 2e-4;
  /// G61: deviation that counts as exact.
  double exact_tolerance_mm = 1e-4;
};

}  // namespace kinebus
