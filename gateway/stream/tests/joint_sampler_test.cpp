#include "gateway/stream/joint_sampler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/stream/tests/m1_axes.hpp"
#include "gateway/stream/tests/motions.hpp"

namespace kinebus::testing {
namespace {

constexpr std::size_t kJoints = 6;

/// Largest distance of the spans from the exact inverse kinematics, mm, at nine places of each span.
double worst_error_mm(const Kinematics& kinematics, const std::vector<Phase>& phases,
                      const std::vector<JointSpan>& spans) {
  double worst = 0, phase_start = 0;
  std::size_t k = 0;
  for (const JointSpan& span : spans) {
    while (span.start_s >= phase_start + phases[k].duration_s - 1e-9 && k + 1 < phases.size())
      phase_start += phases[k++].duration_s;
    for (int i = 0; i <= 8; ++i) {
      const double t = span.duration_s * i / 8;
      JointPoint exact;
      EXPECT_TRUE(kinematics.inverse_along(phases[k].piece.frame,
                                           phases[k].at(span.start_s - phase_start + t), exact));
      for (std::size_t j = 0; j < kJoints; ++j)
        worst = std::max(worst, std::abs(span.position(static_cast<int>(j), t) - exact.q[j]));
    }
  }
  return worst;
}

TEST(JointSampler, StaysWithinItsToleranceOnLinesAndTiltedCurves) {
  const auto kinematics = m1();
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    for (const double length : {1.0, 5.0, 40.0}) {
      const auto phases =
          printed_lines(seed, {.lines = 40, .mean_length_mm = length, .speed_mm_per_s = 30 + 4 * length});
      EXPECT_LE(worst_error_mm(*kinematics, phases, sample(*kinematics, phases)), 35e-6) << "seed " << seed;
    }
    const auto curve = smooth_curve(seed, {.seconds = 2, .tilt_rad = 0.4, .turn_rad = 1.0});
    EXPECT_LE(worst_error_mm(*kinematics, curve, sample(*kinematics, curve)), 35e-6) << "seed " << seed;
  }
}

TEST(JointSampler, SpansJoinWithEqualValueAndSlope) {
  const auto kinematics = m1();
  const auto spans = sample(*kinematics, printed_lines(7, {.lines = 60}));
  for (std::size_t k = 1; k < spans.size(); ++k) {
    const JointSpan &a = spans[k - 1], &b = spans[k];
    EXPECT_DOUBLE_EQ(a.start_s + a.duration_s, b.start_s);
    for (int j = 0; j < static_cast<int>(kJoints); ++j) {
      EXPECT_NEAR(a.position(j, a.duration_s), b.position(j, 0), 1e-10);
      EXPECT_NEAR(a.velocity(j, a.duration_s), b.velocity(j, 0), 1e-7);
    }
    EXPECT_FALSE(a.last);
  }
  EXPECT_TRUE(spans.back().last);
  EXPECT_NEAR(spans.back().velocity(0, spans.back().duration_s), 0, 1e-9);
}

TEST(JointSampler, PhasesOfNanosecondsMakeNoSpikesOfAcceleration) {
  const auto kinematics = m1();
  auto phases = printed_lines(4, {.lines = 30});
  // A cut 5 ns before the end of every phase, as rounding in a planner makes it.
  std::vector<Phase> cut;
  for (const Phase& phase : phases) {
    Phase head = phase, tail = phase;
    head.duration_s -= 5e-9;
    head.last = false;
    tail.s0 = phase.s(head.duration_s);
    tail.v0 = phase.speed(head.duration_s);
    tail.duration_s = 5e-9;
    cut.push_back(head);
    cut.push_back(tail);
  }
  for (const JointSpan& span : sample(*kinematics, cut))
    for (std::size_t j = 0; j < kJoints; ++j)
      for (const double t : {0.0, span.duration_s})
        EXPECT_LT(std::abs(2 * span.coefficients[j][2] + 6 * span.coefficients[j][3] * t), 5000);
}

TEST(JointSampler, TakesOneEvaluationForMostSpansOfAPrint) {
  const auto kinematics = m1();
  JointSampler sampler(*kinematics);
  for (const Phase& phase : printed_lines(3, {.lines = 300})) {
    ASSERT_TRUE(sampler.push(phase));
    while (*sampler.next()) {
    }
  }
  EXPECT_LT(static_cast<double>(sampler.counters().evaluations),
            1.4 * static_cast<double>(sampler.counters().phases));
}

TEST(JointSampler, NamesTheLineThatLeavesTheReach) {
  const auto kinematics = m1();
  Phase phase;
  phase.line = 12;
  phase.piece.coefficients[kX] = {0, 1, 0, 0};
  phase.piece.length = 2000;
  phase.a = 1000;
  phase.duration_s = 1.9;  // to x = 1.8 m
  JointSampler sampler(*kinematics);
  ASSERT_TRUE(sampler.push(phase));
  auto span = sampler.next();
  while (span && *span) span = sampler.next();
  ASSERT_FALSE(span);
  EXPECT_EQ(span.error().kind, StreamError::Kind::kPose);
  EXPECT_EQ(span.error().line, 12u);
}

TEST(JointSampler, RefusesARunThatDoesNotBeginOrEndAtRest) {
  const auto kinematics = m1();
  Phase phase;
  phase.piece.coefficients[kX] = {0, 1, 0, 0};
  phase.v0 = 10;
  phase.duration_s = 0.1;
  JointSampler sampler(*kinematics);
  EXPECT_EQ(sampler.push(phase).error().kind, StreamError::Kind::kNotAtRest);
  phase.v0 = 0;
  phase.a = 10;
  phase.last = true;
  EXPECT_EQ(sampler.push(phase).error().kind, StreamError::Kind::kNotAtRest);
}

}  // namespace
}  // namespace kinebus::testing
