#include "gateway/gcode/curves/arc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace kinebus::gcode {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// `start` turned about the centre by the arc's sweep.
Point2 swept_end(Point2 start, const ArcGeometry& arc, bool clockwise) {
  const double angle = clockwise ? -arc.sweep_rad : arc.sweep_rad;
  const double x = start[0] - arc.centre[0], y = start[1] - arc.centre[1];
  return {arc.centre[0] + x * std::cos(angle) - y * std::sin(angle),
          arc.centre[1] + x * std::sin(angle) + y * std::cos(angle)};
}

double distance(Point2 a, Point2 b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

TEST(Arc, RandomCentreArcsEndWhereTheySay) {
  constexpr unsigned kSeed = 3;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> place(-100, 100), angle(0, kTurn), error(-0.004, 0.004);
  for (int i = 0; i < 20000; ++i) {
    const double radius = 0.1 + std::abs(place(random)), from = angle(random), sweep = angle(random);
    const bool clockwise = (i & 1) != 0;
    const int turns = 1 + i % 3;
    const Point2 centre = {place(random), place(random)};
    const Point2 start = {centre[0] + radius * std::cos(from), centre[1] + radius * std::sin(from)};
    const double to = clockwise ? from - sweep : from + sweep, off = radius + error(random);
    const Point2 end = {centre[0] + off * std::cos(to), centre[1] + off * std::sin(to)};
    const auto arc = arc_by_centre(start, end, centre, clockwise, turns, 0.005);
    ASSERT_TRUE(arc) << arc.error() << " seed " << kSeed << " case " << i;
    ASSERT_NEAR(distance(start, arc->centre), distance(arc->end, arc->centre), 1e-9) << i;
    ASSERT_LT(distance(swept_end(start, *arc, clockwise), arc->end), 1e-7) << i;
    ASSERT_LE(distance(arc->end, end), 0.005) << i;
    ASSERT_LE(distance(arc->centre, centre), 0.0501) << i;
    ASSERT_GT(arc->sweep_rad, kTurn * (turns - 1)) << i;
    ASSERT_LE(arc->sweep_rad, kTurn * turns + 1e-12) << i;
    // Near whole turns the end's error may decide between none and one.
    if (sweep < 0.2 || sweep > kTurn - 0.2) continue;
    ASSERT_NEAR(arc->sweep_rad, sweep + kTurn * (turns - 1), 0.15 / radius + 1e-9) << i;
  }
}

TEST(Arc, RandomRadiusArcsHaveTheirRadiusAndTheAskedHalf) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-100, 100);
  for (int i = 0; i < 20000; ++i) {
    const Point2 start = {place(random), place(random)}, end = {place(random), place(random)};
    const double radius = distance(start, end) / 2 * (1 + std::abs(place(random)) / 50);
    if (radius < 1e-3) continue;
    const bool clockwise = (i & 1) != 0, longer = (i & 2) != 0;
    const auto arc = arc_by_radius(start, end, longer ? -radius : radius, clockwise, 1, 0.005);
    ASSERT_TRUE(arc) << arc.error();
    ASSERT_NEAR(distance(start, arc->centre), radius, 1e-9 * radius + 1e-9);
    ASSERT_NEAR(distance(end, arc->centre), radius, 1e-9 * radius + 1e-9);
    ASSERT_LT(distance(swept_end(start, *arc, clockwise), end), 1e-6) << i;
    ASSERT_LE(longer ? kTurn - arc->sweep_rad : arc->sweep_rad, kTurn / 2 + 1e-6) << i;
  }
}

TEST(Arc, EndAtTheStartIsAFullCircle) {
  const auto arc = arc_by_centre({10, 0}, {10, 0}, {0, 0}, true, 2, 0.005);
  ASSERT_TRUE(arc);
  EXPECT_DOUBLE_EQ(arc->sweep_rad, 2 * kTurn);
}

TEST(Arc, RadiiBeyondTheToleranceAreRefused) {
  EXPECT_FALSE(arc_by_centre({10, 0}, {0, 10.006}, {0, 0}, false, 1, 0.005));
  EXPECT_TRUE(arc_by_centre({10, 0}, {0, 10.004}, {0, 0}, false, 1, 0.005));
  EXPECT_FALSE(arc_by_radius({0, 0}, {10.01, 0}, 5, false, 1, 0.005));
  EXPECT_TRUE(arc_by_radius({0, 0}, {10.004, 0}, 5, false, 1, 0.005));
}

}  // namespace
}  // namespace kinebus::gcode
