#pragma once
// Limits along the path: pieces are looked at in as many places as their shape asks for, and divided where
// joints come near to their limits, so that the terms of PointLimits hardly vary on each part.

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/lookahead.hpp"
#include "gateway/motion/motion_limits.hpp"
#include "gateway/motion/point_limits.hpp"
#include "gateway/result.hpp"

namespace kinebus {

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
  void restart() {
    tail_valid_ = false;
    before_ = {};
  }
  /// Limits for the pieces from here on.
  void set_limits(const MotionLimits& limits) { limits_.set_limits(limits); }

 private:
  struct Sample {
    PosePoint pose;
    JointPoint joints;
  };
  void begin_jerk(const PieceDemand& demand, const PathPiece& geometry);
  bool jump_terms(const PathPiece& geometry, JerkTerms& terms, JointJerkTerms& joints) const;
  void put(const JerkTerms& terms, const JointJerkTerms* joints, PlanPiece& piece);
  Result<void, PoseError> evaluate(Frame frame, Sample& sample) const;
  Result<void, PoseError> start_of_line(const PathPiece& geometry);
  Result<void, PoseError> add_line_parts(const PieceDemand& demand, const PathPiece& geometry,
                                         const PlanPiece& whole, double tool_rate, int parts);
  Result<void, PoseError> add_curve_parts(const PieceDemand& demand, const PathPiece& geometry, int parts,
                                          bool near);

  const Kinematics* kinematics_;
  PointLimits limits_;
  Lookahead* lookahead_;
  std::size_t joints_;
  // Joints at the end of the newest piece, along its direction, with no bend of the path in q''.
  JointPoint tail_{};
  bool tail_valid_ = false;
  PathPiece before_{};  ///< that before the newest; length 0: none. Kept where jerk is limited
};

}  // namespace kinebus
