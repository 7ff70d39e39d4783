// Job time with limited jerk against the sampled optimum on the path that was planned.

#include "gateway/motion/tests/jerk_optimal.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "gateway/motion/tests/test_machine.hpp"
#include "gateway/motion/tests/time_optimal.hpp"
#include "gateway/motion/tests/trajectory_probe.hpp"

namespace kinebus::probe {
namespace {

MotionLimits limits_of_jerk() {
  MotionLimits limits;
  limits.tool_jerk_mm_per_s3 = 100'000;
  for (std::size_t j = 0; j < kMaxJoints; ++j)
    limits.joint_jerk_per_s3[j] =
        limits.tool_jerk_mm_per_s3 * limits.joint_accel_per_s2[j] / limits.tool_accel_mm_per_s2;
  return limits;
}

struct Compared {
  double over_optimum = 0, over_trapezoid = 0;  ///< of the plan; of the optimum over that without jerk limit
};

Compared compare(Lines lines, double feed) {
  for (auto& line : lines)
    if (auto* move = std::get_if<canonical::Feed>(&line.command)) move->feed_per_s = feed;
  const MotionLimits limits = limits_of_jerk();
  const Measured m = measure(m1(), limits, lines, 4, true);
  EXPECT_TRUE(m.planned) << m.error;
  const JerkOptimum best = jerk_optimal(
      m1(), limits, m.all, [feed](std::uint32_t) { return feed; }, 0.05);
  EXPECT_LE(best.gap, 2e-3);
  const Compared compared{m.duration_s / best.time_s,
                          best.time_s / time_optimal_s(m1(), limits, m.all, feed, 0.05)};
  // The plan is one of those that the reference chooses from, but for its grid.
  EXPECT_GE(compared.over_optimum, 0.995);
  EXPECT_GE(compared.over_trapezoid, 0.995);
  return compared;
}

TEST(JerkOptimal, ReferenceFindsTheFormulaOfALineFromRestToRest) {
  const MotionLimits limits = limits_of_jerk();
  const Measured m = measure(m1(), limits, Job().feed(100).to({50, 0, 0, 0, 0, 0}).lines(), 8, true);
  const JerkOptimum best = jerk_optimal(
      m1(), limits, m.all, [](std::uint32_t) { return 100.0; }, 0.01);
  EXPECT_NEAR(best.time_s, 50.0 / 100 + 100.0 / 3000 + 3000 / 98'000.0, 3e-3);
}

TEST(JerkOptimal, PlansAreNearIt) {
  EXPECT_LE(compare(random_print(7, 80), 60).over_optimum, 1.07);
  EXPECT_LE(compare(dense_curve(800, 30, 0, 0, 0), 100).over_optimum, 1.022);
  EXPECT_LE(compare(dense_curve(800, 30, 0, 0.5, 1), 100).over_optimum, 1.036);
}

/// Facets of a curve, as slicers write them: 1.4 mm, 8 degrees, within 5 um. What a jerk limit costs there no
/// planner can save on this path.
TEST(JerkOptimal, FacetsWithinATightToleranceCostTimeAtTheOptimumToo) {
  Job job;
  for (int i = 0; i < 45; ++i) {
    const double angle = i * 8 * 3.14159265358979 / 180;
    job.by({1.4 * std::cos(angle), 1.4 * std::sin(angle), 0, 0, 0, 0.05});
  }
  const Compared compared = compare(job.lines(), 60);
  EXPECT_GE(compared.over_trapezoid, 1.2);
  EXPECT_LE(compared.over_optimum, 1.04);
}

/// As in the teeth of a sliced gear: beside one bend of three a line is too short for a ramp to its cap.
TEST(JerkOptimal, ABendWithoutRoomForItsCapIsPassedAsFastAsThereIsRoom) {
  Job job;
  double angle = 0;
  for (int i = 0; i < 45; ++i) {
    constexpr std::array kLength_mm{1.63, 0.46, 0.40}, kTurn_rad{0.24, 0.44, 0.22};
    const double mm = kLength_mm[i % 3];
    job.by({mm * std::cos(angle), mm * std::sin(angle), 0, 0, 0, 0.05});
    angle += kTurn_rad[i % 3];
  }
  EXPECT_LE(compare(job.lines(), 60).over_optimum, 1.14);
}

/// Between two bends that are nearly one there is no room to change the speed. Both are passed alike, and the
/// long lines beside them are not crept along: from stop to stop they would take little more.
TEST(JerkOptimal, LongLinesBesideTwoBendsAreNotCreptAlong) {
  const MotionLimits limits = limits_of_jerk();
  std::mt19937_64 random(5);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 100; ++i) {
    Job job, line;
    double angle = 0;
    for (const bool is_long : {true, false, true, false, true}) {
      const double mm = is_long ? 50 : draw(0.02, 0.06);
      job.feed(120).by({mm * std::cos(angle), mm * std::sin(angle), 0, 0, 0, 0});
      angle += draw(0.5, 1.4);
    }
    line.feed(120).by({50, 0, 0, 0, 0, 0});
    EXPECT_LE(measure(m1(), limits, job.lines(), 4).duration_s,
              3.2 * measure(m1(), limits, line.lines(), 4).duration_s)
        << i;
  }
}

}  // namespace
}  // namespace kinebus::probe
