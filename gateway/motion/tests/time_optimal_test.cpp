#include "gateway/motion/tests/time_optimal.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "gateway/motion/tests/test_machine.hpp"
#include "gateway/motion/tests/trajectory_probe.hpp"

namespace kinebus::probe {
namespace {

const MotionLimits kProbeLimits;
constexpr double kFastest = 1e5;  // a feed that is no limit

Lines at_feed(Lines lines, double feed) {
  for (auto& line : lines) {
    if (auto* move = std::get_if<canonical::Feed>(&line.command)) move->feed_per_s = feed;
    if (auto* move = std::get_if<canonical::Arc>(&line.command)) move->feed_per_s = feed;
  }
  return lines;
}

/// Planned time over the time-optimal profile's, on the path that was planned.
double over_optimal(const Lines& lines, double feed, double grid_mm = 0.05) {
  const Measured m = measure(m1(), kProbeLimits, at_feed(lines, feed), 4, true);
  expect_within_limits(m, kProbeLimits, 0.005);
  return m.duration_s / time_optimal_s(m1(), kProbeLimits, m.all, feed, grid_mm);
}

TEST(TimeOptimal, ReferenceFindsTheTrapezoid) {
  const Measured m = measure(m1(), kProbeLimits, Job().feed(100).to({50, 0, 0, 0, 0, 0}).lines(), 8, true);
  EXPECT_NEAR(time_optimal_s(m1(), kProbeLimits, m.all, 100, 0.01), 50.0 / 100 + 100.0 / 3000, 1e-4);
}

TEST(TimeOptimal, PrintIsWithinThreePercent) {
  for (const double feed : {50.0, 120.0, kFastest}) EXPECT_LE(over_optimal(random_print(7, 600), feed), 1.03);
}

TEST(TimeOptimal, DenseCurveIsWithinSevenPercentAlsoWhereCurvatureSetsItsSpeed) {
  EXPECT_LE(over_optimal(dense_curve(1500, 30, 0, 0, 0), 100), 1.01);
  EXPECT_LE(over_optimal(dense_curve(1500, 30, 0, 0, 0), kFastest), 1.07);
  EXPECT_LE(over_optimal(dense_curve(1500, 5, 0, 0, 0), kFastest), 1.07);
}

TEST(TimeOptimal, TiltedCurveIsWithinSevenPercentAlsoWhereJointsSetItsSpeed) {
  EXPECT_LE(over_optimal(dense_curve(1500, 30, 0, 0.5, 1), 100), 1.01);
  EXPECT_LE(over_optimal(dense_curve(1500, 30, 0, 0.5, 1), kFastest), 1.07);
  EXPECT_LE(over_optimal(dense_curve(1500, 60, 0, 0.7, 1), kFastest), 1.07);
}

TEST(TimeOptimal, RandomFiveAxisMotionIsWithinThreePercent) {
  for (std::uint64_t seed = 500; seed < 504; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << " of random_five_axis");
    const Frame frame = seed % 2 == 0 ? Frame::kPart : Frame::kMachine;
    EXPECT_LE(over_optimal(random_five_axis(seed, 250, frame), kFastest), 1.03);
  }
}

}  // namespace
}  // namespace kinebus::probe
