#pragma once
// The reference: the fastest speed profile along a given path under the same limits, on a fine grid, by
// reachability (controllable sets backward, then greedily forward, as TOPP-RA does it). Slow and simple on
// purpose; it shares no code with the planner's limits and look-ahead. Constraints at each grid point, in x =
// (ds/dt)^2 and a = d2s/dt2:
//   tool: |x_ss x + x_s a| <= A as a vector, and its speed; feed; pose axes and joints: |q_ss x + q_s a| <=
//   limit.

#include <vector>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/motion_limits.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus::probe {

/// Least time for the path on which `phases` run, s, from rest to rest. feed_mm_per_s: programmed tool speed,
/// the same all along. grid_mm: longest step (each piece has at least 8).
double time_optimal_s(const Kinematics& kinematics, const MotionLimits& limits,
                      const std::vector<Phase>& phases, double feed_mm_per_s, double grid_mm);

}  // namespace kinebus::probe
