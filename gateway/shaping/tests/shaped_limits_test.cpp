#include "gateway/shaping/shaped_limits.hpp"

#include <gtest/gtest.h>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus {
namespace {

/// X from 10 mm with this speed and acceleration, for 10 ms.
Phase along_x(double speed, double accel) {
  Phase phase;
  phase.timed = true;
  phase.v0 = 1;
  phase.duration_s = phase.piece.length = 0.01;
  phase.piece.frame = Frame::kMachine;
  phase.piece.coefficients[kX] = {10, speed, 0.5 * accel, 0};
  return phase;
}

TEST(ShapedLimits, NamesTheJointAndWhatItIsAskedFor) {
  const auto made = make_cartesian_kinematics(CartesianGeometry{});
  ASSERT_TRUE(made);
  JointVector speed{}, accel{};
  speed.fill(200);
  accel.fill(2000);
  speed[0] = 100;
  const ShapedLimits limits(**made, speed, accel);
  EXPECT_FALSE(limits.excess(along_x(80, 2000)));
  const auto fast = limits.excess(along_x(110, 0));
  ASSERT_TRUE(fast);
  EXPECT_EQ(fast->joint, 0);
  EXPECT_FALSE(fast->acceleration);
  EXPECT_NEAR(fast->ratio, 1.1, 1e-9);
  const auto hard = limits.excess(along_x(0, -2400));
  ASSERT_TRUE(hard);
  EXPECT_EQ(hard->joint, 0);
  EXPECT_TRUE(hard->acceleration);
  EXPECT_NEAR(hard->ratio, 1.2, 1e-9);
}

}  // namespace
}  // namespace kinebus
