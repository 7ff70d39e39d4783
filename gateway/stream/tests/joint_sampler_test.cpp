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
  auto refused = sampler.push(phase);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, StreamError::Kind::kNotAtRest);
  EXPECT_NEAR(refused.error().amount, 10, 1e-9);
  phase.v0 = 0;
  phase.a = 10;
  phase.last = true;
  refused = sampler.push(phase);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, StreamError::Kind::kNotAtRest);
  EXPECT_NEAR(refused.error().amount, 1, 1e-9);
  phase.last = false;
  ASSERT_TRUE(sampler.push(phase));
  refused = sampler.push(phase);
  ASSERT_FALSE(refused) << "the one before is not taken";
  EXPECT_EQ(refused.error().kind, StreamError::Kind::kPhaseOrder);
}

TEST(JointSampler, ARotaryJointHasItsOwnTolerance) {
  const auto kinematics = m1();
  const auto slow = smooth_curve(5, {.seconds = 20, .speed_mm_per_s = 12, .tilt_rad = 0.4, .turn_rad = 1.5});
  const auto spans = sample(*kinematics, slow);
  double worst_rad = 0, phase_start = 0;
  std::size_t k = 0;
  for (const JointSpan& span : spans) {
    while (span.start_s >= phase_start + slow[k].duration_s - 1e-9 && k + 1 < slow.size())
      phase_start += slow[k++].duration_s;
    for (int i = 1; i < 8; ++i) {
      const double t = span.duration_s * i / 8;
      JointPoint exact;
      ASSERT_TRUE(
          kinematics->inverse_along(slow[k].piece.frame, slow[k].at(span.start_s - phase_start + t), exact));
      worst_rad = std::max(worst_rad, std::abs(span.position(4, t) - exact.q[4]));
    }
  }
  EXPECT_LE(worst_rad, 1.8e-6);
  EXPECT_LE(worst_error_mm(*kinematics, slow, spans), 35e-6);
}

TEST(JointSampler, WithAMapTheSpansAreInTheMotorsCoordinates) {
  const auto kinematics = m1();
  JointSampler::Options options;
  JointCalibration calibration;
  calibration.pitch = 5;
  calibration.periodic_sine = 0.02;
  calibration.periodic_cosine = -0.01;
  const auto map = std::make_shared<const JointMap>(calibration);
  options.maps[1] = map;
  for (const double speed : {8.0, 150.0}) {
    const auto phases = printed_lines(2, {.lines = 20, .mean_length_mm = 30, .speed_mm_per_s = speed});
    JointSampler sampler(*kinematics, options);
    double phase_start = 0, worst = 0, worst_slope = 0;
    for (const Phase& phase : phases) {
      ASSERT_TRUE(sampler.push(phase));
      EXPECT_FALSE(sampler.wants_phase());
      EXPECT_NEAR(sampler.end_s(), phase_start + phase.duration_s, 1e-9);
      for (auto span = sampler.next(); span && *span; span = sampler.next()) {
        const JointSpan& s = **span;
        for (int i = 0; i <= 16; ++i) {
          const double t = s.duration_s * i / 16;
          JointPoint exact;
          ASSERT_TRUE(
              kinematics->inverse_along(phase.piece.frame, phase.at(s.start_s - phase_start + t), exact));
          const JointMap::Value v = map->at(exact.q[1]);
          worst = std::max(worst, std::abs(s.position(1, t) - v.g));
          worst = std::max(worst, std::abs(s.position(0, t) - exact.q[0]));
          if (i == 0 || i == 16)
            worst_slope = std::max(worst_slope, std::abs(s.velocity(1, t) - v.g1 * exact.q1[1]));
        }
      }
      phase_start += phase.duration_s;
    }
    EXPECT_TRUE(sampler.ended());
    EXPECT_LE(worst, 35e-6) << speed;
    EXPECT_LE(worst_slope, 1e-6) << speed;
  }
}

TEST(JointSampler, CountsWhatItDoesAndChecksShortSpansForNothing) {
  const auto kinematics = m1();
  // 5 ms a phase, hardly more: one evaluation a span, and the first knot.
  const auto phases = smooth_curve(1, {.seconds = 2, .piece_mm = 0.4});
  JointSampler sampler(*kinematics);
  std::uint64_t spans = 0;
  for (const Phase& phase : phases) {
    ASSERT_TRUE(sampler.push(phase));
    while (*sampler.next()) ++spans;
  }
  EXPECT_EQ(sampler.counters().phases, phases.size());
  EXPECT_EQ(sampler.counters().spans, spans);
  EXPECT_GE(sampler.counters().evaluations, spans + 1);
  EXPECT_LE(sampler.counters().evaluations, spans + 5);
  // Longer ones have their middle looked at, too.
  JointSampler other(*kinematics);
  spans = 0;
  for (const Phase& phase : printed_lines(3, {.lines = 20, .mean_length_mm = 40, .speed_mm_per_s = 40})) {
    ASSERT_TRUE(other.push(phase));
    while (*other.next()) ++spans;
  }
  EXPECT_GT(other.counters().evaluations, spans * 3 / 2);
}

TEST(JointSampler, PhasesTooShortForASpanGoIntoTheNext) {
  const auto kinematics = m1();
  const auto phases = printed_lines(4, {.lines = 30});
  std::vector<Phase> cut;
  double total = 0;
  for (const Phase& phase : phases) {
    constexpr double kShort = 1.5e-7;
    Phase head = phase, tail = phase;
    head.duration_s = kShort;
    head.last = false;
    tail.s0 = phase.s(kShort);
    tail.v0 = phase.speed(kShort);
    tail.duration_s -= kShort;
    cut.push_back(head);
    cut.push_back(tail);
    total += phase.duration_s;
  }
  // The last one, too, may be as short: the run ends with it all the same.
  Phase end = cut.back();
  cut.back().last = false;
  end.s0 = end.s(end.duration_s);
  end.v0 = end.a = 0;
  end.duration_s = 1e-7;
  cut.push_back(end);
  const auto spans = sample(*kinematics, cut);
  double at = 0;
  for (const JointSpan& span : spans) {
    EXPECT_NEAR(span.start_s, at, 1e-12);
    if (!span.last) {
      EXPECT_GT(span.duration_s, 2e-7);
    }
    at = span.start_s + span.duration_s;
  }
  EXPECT_NEAR(at, total + 1e-7, 1e-10);
  EXPECT_TRUE(spans.back().last);
  EXPECT_LE(worst_error_mm(*kinematics, phases, sample(*kinematics, phases)), 35e-6);
}

TEST(JointSampler, ARunEndsAtRestWhateverThePlannersRoundingLeaves) {
  const auto kinematics = m1();
  Phase phase;
  phase.piece.coefficients[kX] = {0, 1, 0, 0};
  phase.piece.length = 5;
  phase.v0 = 0.0005;
  phase.a = 10;
  phase.duration_s = 0.1;
  JointSampler sampler(*kinematics);
  ASSERT_TRUE(sampler.push(phase));
  auto span = sampler.next();
  EXPECT_EQ((*span)->velocity(0, 0), 0) << "and begins there";
  while (*sampler.next()) {
  }
  phase.s0 = phase.s(0.1);
  phase.v0 = 1.0005;
  phase.a = -10;
  phase.last = true;
  EXPECT_TRUE(sampler.wants_phase());
  ASSERT_TRUE(sampler.push(phase));
  JointSpan last;
  for (auto next = sampler.next(); *next; next = sampler.next()) last = **next;
  EXPECT_TRUE(last.last);
  for (int j = 0; j < static_cast<int>(kJoints); ++j) EXPECT_NEAR(last.velocity(j, last.duration_s), 0, 1e-9);
  EXPECT_FALSE(sampler.wants_phase());
  EXPECT_EQ(sampler.push(phase).error().kind, StreamError::Kind::kPhaseOrder);
  sampler.restart();
  EXPECT_TRUE(sampler.wants_phase());
}

TEST(JointSampler, SaysWhyAPoseCannotBeTaken) {
  const auto kinematics = m1();
  Phase phase;
  phase.line = 4;
  phase.piece.coefficients[kX] = {1800, 1, 0, 0};
  phase.duration_s = 0.1;
  JointVector joints;
  const auto exact = kinematics->inverse(phase.piece.frame, phase.at(0).x, joints);
  ASSERT_FALSE(exact);
  JointSampler sampler(*kinematics);
  const auto refused = sampler.push(phase);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, StreamError::Kind::kPose);
  EXPECT_EQ(refused.error().line, 4u);
  EXPECT_EQ(refused.error().pose.kind, exact.error().kind);
  EXPECT_EQ(refused.error().pose.joint, exact.error().joint);
  EXPECT_EQ(refused.error().pose.amount, exact.error().amount);
}

TEST(JointSampler, AnErrorThatRepeatsIsSeenWhereverASpansEndsAndMiddleLie) {
  const auto kinematics = m1();
  JointSampler::Options options;
  JointCalibration calibration;
  calibration.pitch = 5;
  calibration.periodic_sine = 0.05;
  const auto map = std::make_shared<const JointMap>(calibration);
  for (std::size_t j = 0; j < 4; ++j) options.maps[j] = map;
  // Straight up at two pitches in each of the longest spans: ends and middle would all lie on whole pitches.
  for (const double speed : {40.0, 150.0, 12.3}) {
    JointSampler sampler(*kinematics, options);
    Phase phase;
    phase.piece.coefficients[kZ] = {10, 1, 0, 0};
    phase.piece.length = 200;
    phase.a = 2000;
    phase.duration_s = speed / 2000;
    Phase cruise = phase;
    cruise.s0 = phase.s(phase.duration_s);
    cruise.v0 = speed;
    cruise.a = 0;
    cruise.duration_s = 50 / speed;
    ASSERT_TRUE(sampler.push(phase));
    while (*sampler.next()) {
    }
    ASSERT_TRUE(sampler.push(cruise));
    double worst = 0;
    for (auto span = sampler.next(); *span; span = sampler.next()) {
      const JointSpan& s = **span;
      for (int i = 0; i <= 16; ++i) {
        JointPoint exact;
        const double t = s.duration_s * i / 16;
        ASSERT_TRUE(kinematics->inverse_along(cruise.piece.frame, cruise.at(s.start_s - phase.duration_s + t),
                                              exact));
        for (int j = 0; j < 4; ++j)
          worst =
              std::max(worst, std::abs(s.position(j, t) - map->at(exact.q[static_cast<std::size_t>(j)]).g));
      }
    }
    EXPECT_LE(worst, 35e-6) << speed;
    // And in no more spans than that takes.
    EXPECT_LE(static_cast<double>(sampler.counters().spans), 115) << speed;
    EXPECT_LE(static_cast<double>(sampler.counters().evaluations),
              2.2 * static_cast<double>(sampler.counters().spans))
        << speed;
  }
}

}  // namespace
}  // namespace kinebus::testing
