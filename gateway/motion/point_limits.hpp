#pragma once
// What a piece of path may do by its limits, once its terms are known at points: speed, and acceleration at a
// given speed, from the feed, the tool (as a vector), each pose axis and each joint (both terms of q'').

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/lookahead.hpp"
#include "gateway/motion/motion_limits.hpp"

namespace kinebus {

/// What the moves say about a piece, besides its shape.
struct PieceDemand {
  double speed = 0;            ///< feed as ds/dt; infinite: none
  double accel_mm_per_s2 = 0;  ///< tool acceleration
  std::uint32_t line = 0;
  bool tip_feed = false;  ///< the feed is the tip's speed relative to a part that turns under it (kMachine)
};

// Below this share of a limit a joint is not looked at any closer: on M1 the terms vary by less than the rest
// within an undivided piece.
inline constexpr double kNear = 0.8;
// Used where nothing limits: 1 km/s2 and 1 km/s. Finite, so that 0 x limit stays 0.
inline constexpr double kNoAccel = 1e6;

inline double dot3(const Pose& a, const Pose& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Makes the piece's accelerations bounds of their own at rest and at its cap, which start without any.
inline void allow_any_acceleration(PlanPiece& piece) {
  piece.linear = true;
  piece.up0 = piece.up1 = piece.down0 = piece.down1 = kNoAccel;
}

/// What a stretch of path adds to the tool's jerk: the greatest |x_s|, |x_ss| and |x_sss| of X Y Z on it; of
/// a place without length, the jump of x_ss there.
struct JerkTerms {
  double x1 = 1, x2 = 0, x3 = 0, jump = 0;
  /// The same of filament. Where it turns from feeding to drawing back its advance ends at once, which counts
  /// as a jump of half of e2.
  double e1 = 0, e2 = 0, e3 = 0, e_jump = 0;
  /// Greatest shares: of x_ss and x_sss along the path, and of x_sss across it.
  double along2 = 1, along3 = 1, across3 = 1;
};
/// Greatest magnitudes of the joints' derivatives by s on a stretch of path, and the jumps of the second.
struct JointJerkTerms {
  JointVector q1{}, q2{}, q3{}, jump{};
};

/// Each call lowers what `piece` has by the terms at a point.
class PointLimits {
 public:
  PointLimits(std::size_t joints, const MotionLimits& limits);

  void set_limits(const MotionLimits& limits);
  bool limits_xyz() const { return limited_xyz_; }

  /// First cap, by feed and tool. tool_rate: tool travel per unit of s.
  void set_cap(const PieceDemand& demand, double tool_rate, PlanPiece& piece) const;
  /// Speed caps of the single axes, at a point where x1 and x2 are known.
  void axis_caps(const PosePoint& pose, PlanPiece& piece) const;
  /// Feed of the tip over a part that turns under it.
  void tip_cap(const PieceDemand& demand, const PosePoint& pose, PlanPiece& piece) const;
  /// Filament that follows the tip across its bends, at a point of a curve; before the bend's own cap.
  void bound_flow(const PosePoint& pose, PlanPiece& piece) const;
  void joint_caps(const JointPoint& joints, PlanPiece& piece) const;
  /// How near the joints come to their limits at the piece's cap and acceleration; 1: at one.
  double joint_ratio(const JointPoint& joints, const PlanPiece& piece) const;
  /// Along a straight, where the axes' share of acceleration is the same everywhere.
  void limit_straight_accel(const PosePoint& direction, PlanPiece& piece) const;
  void axis_accels(const PosePoint& pose, PlanPiece& piece) const;
  void joint_accels(const JointPoint& joints, PlanPiece& piece) const;
  /// The joints' terms at both ends of a piece: cap and accelerations.
  void add_joints(const JointPoint& before, const JointPoint& after, PlanPiece& piece) const;
  bool limits_jerk() const { return limits_.limits_jerk(); }
  /// Last of all: even acceleration and jerk, and a cap at which the path's bends leave something for them.
  /// joints: nullptr where they are far from their limits.
  void limit_jerk(const JerkTerms& terms, const JointJerkTerms* joints, PlanPiece& piece) const;
  /// How near the joints' jerk comes to its limit at the piece's cap, after limit_jerk().
  double joint_jerk_ratio(const JointJerkTerms& joints, const PlanPiece& piece) const;
  /// Greatest x where the second derivative by s jumps from `before` to `after`.
  double jump_cap(const Pose& before, const Pose& after) const;
  /// Speed cap and acceleration bounds of geometry's stretch from piece.s0 over piece.length, joints aside.
  void bound_curve(const PieceDemand& demand, const PathPiece& geometry, PlanPiece& piece) const;

 private:
  /// Of axis i along x1.
  double inverse_accel(std::size_t i, const Pose& x1) const {
    return i == kE && inverse_flow_accel_ > inverse_axis_accel_[kE] && dot3(x1, x1) > 0
               ? inverse_flow_accel_
               : inverse_axis_accel_[i];
  }
  double accel_limit(std::size_t i, const Pose& x1) const {
    return i == kE && dot3(x1, x1) > 0 ? std::min(limits_.axis_accel_per_s2[i], limits_.flow_accel_mm_per_s2)
                                       : limits_.axis_accel_per_s2[i];
  }
  /// Greatest x at which the path's bends take `share` of the jerk.
  double bend_cap(double share, const JerkTerms& terms, const JointJerkTerms* joints,
                  const PlanPiece& piece) const;
  PlanPiece::Even even(const JerkTerms& terms, const JointJerkTerms* joints, const PlanPiece& piece,
                       double x) const;

  MotionLimits limits_{};
  std::size_t joints_;
  JointVector inverse_speed_{}, inverse_accel_{}, accel_{}, jerk_{};
  Pose inverse_axis_speed_{}, inverse_axis_accel_{};
  double inverse_flow_accel_ = 0, flow_jerk_ = kUnlimited;
  bool limited_xyz_ = false;  ///< X, Y or Z have limits of their own
};

}  // namespace kinebus
