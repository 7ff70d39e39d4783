#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "gateway/kinematics/tests/derivatives.hpp"

namespace kinebus {
namespace {

using testing::RandomPose;

CartesianGeometry five_axes() {
  CartesianGeometry g;
  g.has_table = true;
  g.table.pivot_mm = {3, -4, -35};
  return g;
}

TEST(Cartesian, JointsAreTheAxes) {
  const auto kinematics = *make_cartesian_kinematics({});
  ASSERT_EQ(kinematics->joint_count(), 4);
  JointVector q{};
  ASSERT_TRUE(kinematics->inverse(Frame::kPart, {1, 2, 3, 0, 0, 4}, q));
  EXPECT_EQ(q, (JointVector{1, 2, 3, 4}));
  EXPECT_EQ(kinematics->joint_info(3).name, "E");
}

TEST(Cartesian, TheToolFollowsTheTurningPart) {
  const auto g = five_axes();
  const auto kinematics = *make_cartesian_kinematics(g);
  ASSERT_EQ(kinematics->joint_count(), 6);
  const Eigen::Vector3d pivot(g.table.pivot_mm.data());
  RandomPose random(21);
  for (int n = 0; n < 1000; ++n) {
    const Pose pose = random.in_m1_cylinder();
    JointVector q{};
    ASSERT_TRUE(kinematics->inverse(Frame::kPart, pose, q));
    // The table carries the part: the tool has to be where the table's rotation takes the point.
    const Eigen::Vector3d expected = pivot + Eigen::AngleAxisd(q[3], Eigen::Vector3d::UnitX()) *
                                                 (Eigen::AngleAxisd(q[4], Eigen::Vector3d::UnitZ()) *
                                                  (Eigen::Vector3d(pose.data()) - pivot));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(q[k], expected[static_cast<long>(k)], 1e-11);
    EXPECT_EQ(q[3], pose[kA]);
    EXPECT_EQ(q[4], pose[kC]);
    EXPECT_EQ(q[5], pose[kE]);
    for (const Frame frame : {Frame::kPart, Frame::kMachine}) {
      Pose found{};
      ASSERT_TRUE(kinematics->inverse(frame, pose, q));
      ASSERT_TRUE(kinematics->forward(frame, q, found));
      for (std::size_t k = 0; k < kPoseAxes; ++k) EXPECT_NEAR(found[k], pose[k], 1e-9);
    }
  }
}

TEST(Cartesian, DerivativesMatchDifferences) {
  const auto kinematics = *make_cartesian_kinematics(five_axes());
  RandomPose random(22);
  for (int n = 0; n < 300 && !::testing::Test::HasFailure(); ++n) {
    const PosePoint path = random.path_through(random.in_m1_cylinder());
    testing::expect_derivatives(*kinematics, Frame::kPart, path, 0.5, 1e-9, 1e-8);
    testing::expect_derivatives(*kinematics, Frame::kMachine, path, 0.5, 1e-9, 1e-8);
  }
}

TEST(Cartesian, CheckNamesTheJointBeyondItsTravel) {
  const auto kinematics = *make_cartesian_kinematics({});
  const auto result = kinematics->check(Frame::kPart, {0, 0, 205, 0, 0, 0});
  ASSERT_FALSE(result);
  EXPECT_EQ(to_string(result.error(), *kinematics), "Z: would be 5.000 mm beyond its travel");
  EXPECT_FALSE(kinematics->check(Frame::kPart, {0, 0, 50, 0.1, 0, 0})) << "there is no A axis";
  const auto with_table = *make_cartesian_kinematics(five_axes());
  EXPECT_TRUE(with_table->check(Frame::kPart, {0, 0, 50, 0.1, 3, 0}));
  const auto tilted = with_table->check(Frame::kMachine, {0, 0, 50, 100 * kRadPerDeg, 0, 0});
  ASSERT_FALSE(tilted);
  EXPECT_EQ(to_string(tilted.error(), *with_table), "A: would be 10.000 deg beyond its travel");
}

TEST(CoreXy, BeltsAddAndSubtract) {
  const auto kinematics = *make_corexy_kinematics({});
  JointVector q{};
  ASSERT_TRUE(kinematics->inverse(Frame::kPart, {10, 3, 5, 0, 0, 7}, q));
  EXPECT_EQ(q, (JointVector{13, 7, 5, 7}));
  Pose pose{};
  ASSERT_TRUE(kinematics->forward(Frame::kPart, q, pose));
  EXPECT_EQ(pose, (Pose{10, 3, 5, 0, 0, 7}));
  RandomPose random(23);
  for (int n = 0; n < 50; ++n)
    testing::expect_derivatives(*kinematics, Frame::kPart, random.path_through(random.in_m1_cylinder()), 0.5,
                                1e-9, 1e-8);
  EXPECT_TRUE(kinematics->check(Frame::kPart, {100, 100, 5, 0, 0, 0}));
  const auto result = kinematics->check(Frame::kPart, {101, 0, 5, 0, 0, 0});
  ASSERT_FALSE(result);
  EXPECT_EQ(to_string(result.error(), *kinematics), "X is 1.000 mm outside the workspace");
}

Pose in_delta(RandomPose& random) {
  const double r = 140 * std::sqrt(random.uniform(0, 1)), f = random.uniform(-3.2, 3.2);
  return {r * std::cos(f), r * std::sin(f), random.uniform(0, 290), 0, 0, random.uniform(-50, 50)};
}

TEST(LinearDelta, ArmsClose) {
  const LinearDeltaGeometry g;
  const auto kinematics = *make_linear_delta_kinematics(g);
  RandomPose random(24);
  for (int n = 0; n < 2000; ++n) {
    const Pose pose = in_delta(random);
    JointVector q{};
    ASSERT_TRUE(kinematics->inverse(Frame::kPart, pose, q));
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d carriage(g.radius_mm * std::cos(g.tower_angle_rad[i]),
                                     g.radius_mm * std::sin(g.tower_angle_rad[i]), q[i]);
      EXPECT_NEAR((carriage - Eigen::Vector3d(pose.data())).norm(), g.arm_length_mm, 1e-10);
      EXPECT_GT(q[i], pose[kZ]);
    }
    EXPECT_EQ(q[3], pose[kE]);
  }
}

TEST(LinearDelta, ForwardFindsThePose) {
  const auto kinematics = *make_linear_delta_kinematics({});
  RandomPose random(25);
  for (int n = 0; n < 5000; ++n) {
    const Pose pose = in_delta(random);
    JointVector q{};
    ASSERT_TRUE(kinematics->inverse(Frame::kPart, pose, q));
    Pose found{};
    const auto result = kinematics->forward(Frame::kPart, q, found);
    ASSERT_TRUE(result) << to_string(result.error());
    for (std::size_t k = 0; k < kPoseAxes; ++k) EXPECT_NEAR(found[k], pose[k], 1e-9);
  }
}

TEST(LinearDelta, DerivativesMatchDifferences) {
  const auto kinematics = *make_linear_delta_kinematics({});
  RandomPose random(26);
  for (int n = 0; n < 1000 && !::testing::Test::HasFailure(); ++n) {
    PosePoint path = random.path_through(in_delta(random));
    testing::expect_derivatives(*kinematics, Frame::kPart, path, 0.5, 1e-9, 1e-8);
  }
}

TEST(LinearDelta, SaysWhatIsWrong) {
  const auto kinematics = *make_linear_delta_kinematics({});
  JointVector q{};
  const auto reach = kinematics->inverse(Frame::kPart, {0, -400, 0, 0, 0, 0}, q);
  ASSERT_FALSE(reach);
  EXPECT_EQ(reach.error().kind, PoseError::Kind::kOutOfReach);
  EXPECT_EQ(reach.error().joint, 2);
  EXPECT_NEAR(reach.error().amount, 400 + 174.75 - 333, 1e-9);
  Pose pose{};
  const auto closed = kinematics->forward(Frame::kPart, {0, 0, 1000, 0}, pose);
  ASSERT_FALSE(closed);
  EXPECT_EQ(closed.error().kind, PoseError::Kind::kNoConvergence);
  EXPECT_GT(closed.error().amount, 0);
  EXPECT_FALSE(kinematics->check(Frame::kPart, {0, 0, 50, 0, 0.1, 0})) << "nothing turns";
  EXPECT_LT(kinematics->condition(Frame::kPart, {0, 0, 50, 0, 0, 0}), 4);
}

TEST(LinearDelta, ImpossibleGeometriesAreRefused) {
  EXPECT_FALSE(make_linear_delta_kinematics({.radius_mm = 400}));
  LinearDeltaGeometry g;
  g.tower_angle_rad[1] = g.tower_angle_rad[0];
  EXPECT_FALSE(make_linear_delta_kinematics(g));
}

}  // namespace
}  // namespace kinebus
