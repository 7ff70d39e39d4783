#pragma once
// Derivatives that know nothing of the formulas under test: eighth-order central differences in long steps.

#include <gtest/gtest.h>

#include "gateway/kinematics/tests/random_pose.hpp"

namespace kinebus::testing {

/// q1 and q2 at s = 0 along `path`, from inverse() alone. Truncation error ~ h^8, rounding ~ 1e-13 / h^2.
inline JointPoint numeric_along(const Kinematics& kinematics, Frame frame, const PosePoint& path, double h) {
  constexpr double kFirst[5] = {0, 4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  constexpr double kSecond[5] = {-205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
  JointPoint out;
  for (int k = -4; k <= 4; ++k) {
    JointVector q{};
    EXPECT_TRUE(kinematics.inverse(frame, at(path, k * h), q));
    const double first = k < 0 ? -kFirst[-k] : kFirst[k], second = kSecond[k < 0 ? -k : k];
    for (std::size_t j = 0; j < kMaxJoints; ++j) {
      if (k == 0) out.q[j] = q[j];
      out.q1[j] += first * q[j] / h;
      out.q2[j] += second * q[j] / (h * h);
    }
  }
  return out;
}

/// inverse_along and jacobian against those, relative to the largest derivative of the pose's joints.
inline void expect_derivatives(const Kinematics& kinematics, Frame frame, const PosePoint& path, double h,
                               double first_relative, double second_relative) {
  JointPoint exact;
  ASSERT_TRUE(kinematics.inverse_along(frame, path, exact));
  const JointPoint numeric = numeric_along(kinematics, frame, path, h);
  double scale1 = 0, scale2 = 0;
  const auto joints = static_cast<std::size_t>(kinematics.joint_count());
  for (std::size_t j = 0; j < joints; ++j) {
    scale1 = std::max(scale1, std::abs(exact.q1[j]));
    scale2 = std::max(scale2, std::abs(exact.q2[j]));
  }
  for (std::size_t j = 0; j < joints; ++j) {
    EXPECT_NEAR(exact.q[j], numeric.q[j], 1e-12 * (1 + std::abs(exact.q[j]))) << "joint " << j;
    EXPECT_NEAR(exact.q1[j], numeric.q1[j], first_relative * scale1) << "joint " << j;
    EXPECT_NEAR(exact.q2[j], numeric.q2[j], second_relative * scale2) << "joint " << j;
  }
  // The Jacobian is what turns x' into q'.
  std::array<double, kMaxJoints * kPoseAxes> matrix{};
  JointVector q{};
  ASSERT_TRUE(kinematics.jacobian(frame, path.x, q, matrix));
  for (std::size_t j = 0; j < joints; ++j) {
    double q1 = 0;
    for (std::size_t k = 0; k < kPoseAxes; ++k) q1 += matrix[j * kPoseAxes + k] * path.x1[k];
    EXPECT_NEAR(q1, exact.q1[j], 1e-12 * scale1) << "joint " << j;
    EXPECT_NEAR(q[j], exact.q[j], 1e-12 * (1 + std::abs(exact.q[j]))) << "joint " << j;
  }
}

}  // namespace kinebus::testing
