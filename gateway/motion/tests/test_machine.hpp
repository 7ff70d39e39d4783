#pragma once
// The machine that planner tests run on, and what must hold for every planned motion.

#include <gtest/gtest.h>

#include "gateway/kinematics/geometry.hpp"
#include "gateway/motion/tests/trajectory_probe.hpp"

namespace kinebus::probe {

/// The default M1.
inline const Kinematics& m1() {
  static const auto machine = make_m1_kinematics(M1Geometry{});
  return **machine;
}

/// No limit is exceeded at any sampled instant, position and velocity are continuous, the run starts and ends
/// at rest at the programmed end, and the path stays within `tolerance_mm` of the programmed one. Joints stay
/// below 0.99 of their limits: the planner leaves 2 % to quantisation.
inline void expect_within_limits(const Measured& m, const MotionLimits& limits, double tolerance_mm) {
  ASSERT_TRUE(m.planned) << m.error;
  EXPECT_LE(m.tool_speed_mm_per_s, limits.tool_speed_mm_per_s * (1 + 1e-6));
  EXPECT_LE(m.tool_accel_mm_per_s2, limits.tool_accel_mm_per_s2 * (1 + 1e-6));
  EXPECT_LE(m.joint_speed_ratio, 0.99);
  EXPECT_LE(m.joint_accel_ratio, 0.99);
  EXPECT_LE(m.axis_speed_ratio, 1 + 1e-6);
  EXPECT_LE(m.axis_accel_ratio, 1 + 1e-4);
  EXPECT_LE(m.path_error_mm, tolerance_mm * (1 + 1e-9) + 1e-9) << "line " << m.path_error_line;
  EXPECT_LE(m.position_jump, 1e-8);
  EXPECT_LE(m.velocity_jump, 1e-6);
  EXPECT_LE(m.speed_at_ends, 1e-6);
  EXPECT_LE(m.end_error, 1e-8);
  EXPECT_TRUE(m.last_marked);
}

}  // namespace kinebus::probe
