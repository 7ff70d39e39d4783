#pragma once
// Limits along the path: what each piece of path allows in speed, and in acceleration at a given speed, from
// the feed, the tool (as a vector), each pose axis and each joint (through the kinematics, both terms of
// q''). Pieces on which joints come near to their limits are divided, so that their terms hardly vary on each
// part.

#include <cstdint>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/lookahead.hpp"
#include "gateway/motion/motion_limits.hpp"
#include "gateway/result.hpp"

namespace kinebus {

/// What the moves say about a piece, besides its shape.
struct PieceDemand {
  double speed = 0;            ///< feed as ds/dt; infinite: none
  double accel_mm_per_s2 = 0;  ///< tool acceleration
  std::uint32_t line = 0;
  bool tip_feed = false;  ///< the feed is the tip's speed relative to a part that turns under it (kMachine)
};

class PathLimits {
 public:
  PathLimits(const Kinematics& kinematics, const MotionLimits& limits, Lookahead& lookahead);

  /// Each takes lookahead's newest geometry, already filled in, and adds the pieces on it. The path is
  /// continuous in position and direction from call to call, except after restart(). Error: the pose that
  /// cannot be reached.
  Result<void, PoseError> add_line(const PieceDemand& demand);
  Result<void, PoseError> add_parabola(const PieceDemand& demand);
  Result<void, PoseError> add_curve(const PieceDemand& demand);

  /// The next piece may begin anywhere (after a stop).
  void restart() { tail_valid_ = false; }
  /// Limits for the pieces from here on.
  void set_limits(const MotionLimits& limits);

 private:
  struct Sample {
    PosePoint pose;
    JointPoint joints;
  };
  Result<void, PoseError> evaluate(Frame frame, Sample& sample) const;
  Result<void, PoseError> start_of_line(const PathPiece& geometry);
  void set_cap(const PieceDemand& demand, double tool_rate, PlanPiece& piece) const;
  void axis_caps(const PosePoint& pose, PlanPiece& piece) const;
  void tip_cap(const PieceDemand& demand, const PosePoint& pose, PlanPiece& piece) const;
  void joint_caps(const JointPoint& joints, PlanPiece& piece) const;
  double joint_ratio(const JointPoint& joints, const PlanPiece& piece) const;
  void axis_accels(const PosePoint& pose, PlanPiece& piece) const;
  void joint_accels(const JointPoint& joints, PlanPiece& piece) const;
  void add_joints(const JointPoint& before, const JointPoint& after, PlanPiece& piece) const;
  void bound_curve(const PieceDemand& demand, const PathPiece& geometry, PlanPiece& piece) const;
  Result<void, PoseError> add_line_parts(const PieceDemand& demand, const PathPiece& geometry,
                                         const PlanPiece& whole, int parts);
  Result<void, PoseError> add_curve_parts(const PieceDemand& demand, const PathPiece& geometry, int parts,
                                          bool near);

  const Kinematics* kinematics_;
  MotionLimits limits_{};
  Lookahead* lookahead_;
  std::size_t joints_;
  JointVector inverse_speed_{}, inverse_accel_{}, accel_{};
  PoseVector inverse_axis_speed_{}, inverse_axis_accel_{};
  bool limited_xyz_ = false;  ///< X, Y or Z have limits of their own
  // Joints at the end of the newest piece, along its direction, with no bend of the path in q''.
  JointPoint tail_{};
  bool tail_valid_ = false;
};

}  // namespace kinebus
