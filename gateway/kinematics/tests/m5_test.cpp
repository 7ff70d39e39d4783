#include <gtest/gtest.h>

#include "gateway/kinematics/tests/derivatives.hpp"

namespace kinebus {
namespace {

using testing::RandomPose;

TEST(M5, IsM1sMechanismWithoutTableAndExtruder) {
  const auto m1 = *make_m1_kinematics({});
  const auto m5 = *make_m5_kinematics({});
  ASSERT_EQ(m5->joint_count(), 4);
  EXPECT_EQ(m5->joint_info(2).name, "rail3");
  RandomPose random(31);
  for (int n = 0; n < 2000; ++n) {
    Pose pose = random.in_m1_cylinder();
    pose[kC] = pose[kE] = 0;
    JointVector q1{}, q5{};
    ASSERT_TRUE(m1->inverse(Frame::kPart, pose, q1));
    ASSERT_TRUE(m5->inverse(Frame::kPart, pose, q5));
    EXPECT_EQ(q1, q5);
    Pose found = random.in_m1_cylinder();
    ASSERT_TRUE(m5->forward(Frame::kPart, q5, found));
    for (std::size_t k = 0; k < kPoseAxes; ++k) EXPECT_NEAR(found[k], pose[k], 1e-9);
  }
}

TEST(M5, DerivativesMatchDifferences) {
  const auto m5 = *make_m5_kinematics({});
  RandomPose random(32);
  for (int n = 0; n < 1000 && !::testing::Test::HasFailure(); ++n) {
    PosePoint path = random.path_through(random.in_m1_cylinder());
    for (const std::size_t axis : {std::size_t{kC}, std::size_t{kE}})
      path.x[axis] = path.x1[axis] = path.x2[axis] = 0;
    testing::expect_derivatives(*m5, Frame::kPart, path, 0.5, 1e-9, 1e-8);
  }
}

TEST(M5, TableAndExtruderMustStandStill) {
  const auto m5 = *make_m5_kinematics({});
  EXPECT_TRUE(m5->check(Frame::kPart, {0, 0, 50, 0.1, 0, 0}));
  EXPECT_EQ(m5->check(Frame::kPart, {0, 0, 50, 0, 0.1, 0}).error().joint, kC);
  EXPECT_EQ(m5->check(Frame::kPart, {0, 0, 50, 0, 0, 3}).error().joint, kE);
}

TEST(M5, ASingularMechanismIsRefused) {
  M5Geometry g;
  g.legs[2].foot_mm = {-273, -63, 0};
  g.legs[2].attachment_mm = {-124, -128, -5};
  g.legs[3].foot_mm = {-273, 63, 0};
  g.legs[3].attachment_mm = {-124, 128, -5};
  ASSERT_FALSE(make_m5_kinematics(g));
}

}  // namespace
}  // namespace kinebus
