// Paper M1's velocity and acceleration (eq. 6-10) against differences that know only eq. 5, each acceleration
// term by itself.

#include <gtest/gtest.h>

#include "gateway/kinematics/tests/derivatives.hpp"

namespace kinebus {
namespace {

using testing::RandomPose;

TEST(M1Derivatives, VelocityAndBothAccelerationTermsTo1e8At10000Poses) {
  const auto m1 = *make_m1_kinematics({});
  RandomPose random(41);
  for (int n = 0; n < 10'000 && !::testing::Test::HasFailure(); ++n) {
    PosePoint path = random.path_through(random.in_m1_cylinder());
    path.x[kE] = 0;  // kilometres of filament would cost the differences their digits
    // J' x' alone: no acceleration of the pose; then J x'' alone: no speed.
    PosePoint coasting = path, starting = path;
    coasting.x2 = {};
    starting.x1 = {};
    // Upright legs bend the carriages' motion little: long steps keep it above the rounding of 1340 mm.
    testing::expect_derivatives(*m1, Frame::kPart, coasting, 1.5, 1e-9, 1e-8);
    JointPoint exact;
    ASSERT_TRUE(m1->inverse_along(Frame::kPart, starting, exact));
    const JointPoint numeric = testing::numeric_along(*m1, Frame::kPart, starting, 0.7);
    double scale = 0;
    for (const double v : exact.q2) scale = std::max(scale, std::abs(v));
    for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(exact.q2[j], numeric.q2[j], 1e-8 * scale) << "pose " << n;
  }
}

}  // namespace
}  // namespace kinebus
