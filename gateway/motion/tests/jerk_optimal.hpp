#pragma once
// The reference where jerk is limited: the fastest speed profile along a given path under the same limits, on
// a fine grid, as one optimisation over all of it (interior point). Slow on purpose, and it shares no code
// with the planner's limits and ramps. Unknown is x = (ds/dt)^2 at each grid point; path acceleration is
// x'/2, and jerk q_s s''' + 3 q_ss s' s'' + q_sss s'^3 is sqrt(x) times what is linear in x, x', x''.

#include <functional>
#include <vector>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/motion_limits.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus::probe {

struct JerkOptimum {
  double time_s = 0;
  std::size_t points = 0;
  int steps = 0;   ///< of Newton's method
  double gap = 0;  ///< what is left to gain at most by its own bound, share of time_s
};

/// Least time for the path on which `phases` run, resting where they do. feed_mm_per_s: programmed tool speed
/// of a line of the job. grid_mm: longest step. jumps: the acceleration may jump where curvature does, of
/// the tool and of each joint as kCurvatureJump_s says; false: as if curvature never jumped, a bound for
/// smoother paths.
JerkOptimum jerk_optimal(const Kinematics& kinematics, const MotionLimits& limits,
                         const std::vector<Phase>& phases,
                         const std::function<double(std::uint32_t line)>& feed_mm_per_s, double grid_mm,
                         bool jumps = true);

}  // namespace kinebus::probe
