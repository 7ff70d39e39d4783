// The sampler on a machine whose joints bend more than its tolerance: as many as there may be, every other
// one rotary.
#include <gtest/gtest.h>

#include <cmath>

#include "gateway/stream/joint_sampler.hpp"

namespace kinebus::testing {
namespace {

/// Joint j is at size * sin(x / 5); no pose between `gap_from` and `gap_to` can be taken.
class Bent : public Kinematics {
 public:
  std::string name() const override { return "bent"; }
  int joint_count() const override { return kMaxJoints; }
  JointInfo joint_info(int joint) const override {
    return {.name = "joint", .rotary = joint % 2 == 1, .min = 0, .max = 0};
  }
  double size(int joint) const { return joint % 2 == 1 ? 0.3 : 0.5; }

  Result<void, PoseError> inverse(Frame, const Pose& pose, JointVector& joints) const override {
    if (pose[kX] > gap_from && pose[kX] < gap_to)
      return Error<PoseError>({.kind = PoseError::Kind::kOutOfReach, .joint = 3, .amount = 2.5});
    for (int j = 0; j < kMaxJoints; ++j)
      joints[static_cast<std::size_t>(j)] = size(j) * std::sin(pose[kX] / 5);
    return {};
  }
  Result<void, PoseError> inverse_along(Frame frame, const PosePoint& pose,
                                        JointPoint& joints) const override {
    if (auto ok = inverse(frame, pose.x, joints.q); !ok) return ok;
    const double s = std::sin(pose.x[kX] / 5), c = std::cos(pose.x[kX] / 5), v = pose.x1[kX] / 5;
    for (int j = 0; j < kMaxJoints; ++j) {
      joints.q1[static_cast<std::size_t>(j)] = size(j) * c * v;
      joints.q2[static_cast<std::size_t>(j)] = size(j) * (c * pose.x2[kX] / 5 - s * v * v);
    }
    return {};
  }
  Result<void, PoseError> jacobian(Frame, const Pose&, JointVector&, std::span<double>) const override {
    return {};
  }
  Result<void, PoseError> forward(Frame, const JointVector&, Pose&) const override { return {}; }
  Result<void, PoseError> check(Frame, const Pose&) const override { return {}; }
  double condition(Frame, const Pose&) const override { return 1; }
  Pose bed_reference() const override { return {}; }

  double gap_from = 1e9, gap_to = 1e9;
};

/// From rest along X, and to rest.
std::vector<Phase> along_x(double speed, double cruise_s) {
  std::vector<Phase> phases(3);
  for (Phase& phase : phases) phase.piece.coefficients[kX] = {0, 1, 0, 0};
  const double accel = 200, ramp = speed / accel;
  phases[0].a = accel;
  phases[0].duration_s = phases[2].duration_s = ramp;
  phases[1].s0 = accel * ramp * ramp / 2;
  phases[1].v0 = phases[2].v0 = speed;
  phases[1].duration_s = cruise_s;
  phases[2].s0 = phases[1].s0 + speed * cruise_s;
  phases[2].a = -accel;
  phases[2].last = true;
  for (std::size_t k = 0; k < 3; ++k) phases[k].line = static_cast<std::uint32_t>(k + 1);
  return phases;
}

TEST(JointSampler, HoldsEachJointOfAMachineToItsOwnTolerance) {
  const Bent kinematics;
  for (const double speed : {2.0, 20.0, 200.0}) {
    JointSampler sampler(kinematics);
    double begun = 0, worst_mm = 0, worst_rad = 0;
    std::size_t spans = 0;
    for (const Phase& phase : along_x(speed, 20 / speed)) {
      ASSERT_TRUE(sampler.push(phase));
      for (;;) {
        const auto span = sampler.next();
        ASSERT_TRUE(span);
        if (!*span) break;
        ++spans;
        for (int i = 0; i <= 16; ++i) {
          const double t = (*span)->duration_s * i / 16;
          const double x = phase.piece.evaluate(phase.s((*span)->start_s - begun + t)).x[kX];
          for (int j = 0; j < kMaxJoints; ++j) {
            const double off = std::abs((*span)->position(j, t) - kinematics.size(j) * std::sin(x / 5));
            double& worst = j % 2 == 1 ? worst_rad : worst_mm;
            worst = std::max(worst, off);
          }
        }
      }
      begun += phase.duration_s;
    }
    EXPECT_LE(worst_mm, 35e-6) << speed;
    EXPECT_LE(worst_rad, 1.8e-6) << speed;
    EXPECT_LT(spans, 400u) << speed;
  }
}

TEST(JointSampler, APathThatLeavesTheReachBetweenTwoKnotsIsRefused) {
  Bent kinematics;
  kinematics.gap_from = 8.4;
  kinematics.gap_to = 8.6;
  JointSampler::Options options;
  options.tolerance_mm = options.tolerance_rad = 1;  // the longest spans
  JointSampler sampler(kinematics, options);
  const auto phases = along_x(20, 1);
  ASSERT_TRUE(sampler.push(phases[0]));
  ASSERT_TRUE(sampler.next());
  ASSERT_TRUE(sampler.push(phases[1]));
  bool refused = false;
  for (int k = 0; k < 8 && !refused; ++k) {
    const auto span = sampler.next();
    refused = !span;
    if (!refused) continue;
    EXPECT_EQ(span.error().kind, StreamError::Kind::kPose);
    EXPECT_EQ(span.error().line, 2u);
    EXPECT_EQ(span.error().pose.joint, 3);
    EXPECT_EQ(span.error().pose.amount, 2.5);
  }
  EXPECT_TRUE(refused);
}

}  // namespace
}  // namespace kinebus::testing
