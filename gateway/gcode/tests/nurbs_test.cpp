// G5.2 and G6.2: what comes out lies on curves that are known otherwise.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "gateway/gcode/curves/nurbs.hpp"
#include "gateway/gcode/programs/job_reader.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kMost_mm = 2e-3;  // what the reference promises

struct Read {
  std::vector<Pose> poses;  ///< where the tool begins, and each end of a feed
  std::string error;
};

Read read(std::string_view text, Options options = {}) {
  options.default_feed_mm_per_s = 10;
  Interpreter interpreter(std::move(options));
  JobReader reader(interpreter);
  CommandBuffer out;
  auto result = reader.read(text, out);
  if (result) result = reader.finish(out);
  Read read;
  if (!result) read.error = to_string(result.error());
  for (const canonical::Line& line : out) {
    if (const auto* start = std::get_if<canonical::SetPosition>(&line.command))
      read.poses.push_back(start->pose);
    if (const auto* feed = std::get_if<canonical::Feed>(&line.command)) read.poses.push_back(feed->target);
  }
  return read;
}

/// A quarter of a circle of 10 mm about 0, 0, from X10: a rational curve of order 3 is one, of two weights 1
/// with cos(45 deg) between.
void expect_quarter(const Read& read, std::size_t u, std::size_t v) {
  ASSERT_EQ(read.error, "");
  ASSERT_GT(read.poses.size(), 10u);
  for (std::size_t i = 0; i < read.poses.size(); ++i) {
    const Pose& p = read.poses[i];
    EXPECT_NEAR(std::hypot(p[u], p[v]), 10, 1e-6);
    if (i == 0) continue;
    const Pose& from = read.poses[i - 1];
    EXPECT_LE(10 - std::hypot(p[u] + from[u], p[v] + from[v]) / 2, kMost_mm);
    EXPECT_GT(std::atan2(p[v], p[u]), std::atan2(from[v], from[u]));
  }
  EXPECT_NEAR(read.poses.back()[v], 10, 1e-9);
}

Options at_x10() {
  Options options;
  options.start = {10, 0, 0, 0, 0, 0};
  return options;
}

TEST(Nurbs, WeightsMakeACircle) {
  expect_quarter(read("G5.2 P1 L3\nX10 Y10 P0.70710678118654752\nX0 Y10 P1\nG5.3\n", at_x10()), 0, 1);
  expect_quarter(read("G18 G91\nG5.2 X0 Z10 P0.70710678118654752\nX-10 Z0\nG5.3\n", at_x10()), 0, 2);
  expect_quarter(
      read("G6.2 P3 K0 X10 Y0 R1 Q1\nK0 X10 Y10 R0.70710678118654752\nK0 X0 Y10 R1\nK1\nK1\nG6.2 K1\n",
           at_x10()),
      0, 1);
}

TEST(Nurbs, OfOneSpanIsABezierCurve) {
  const Read spline = read("G5 X30 Y0 I0 J20 P0 Q-20\n");
  const Read nurbs = read("G5.2 L4\nX0 Y20\nX30 Y-20\nX30 Y0\nG5.3\n");
  ASSERT_EQ(nurbs.error, "");
  for (const Pose& p : nurbs.poses) {
    double nearest = 1e9;
    for (std::size_t i = 1; i < spline.poses.size(); ++i)
      for (int share = 0; share <= 20; ++share) {
        const Pose &a = spline.poses[i - 1], &b = spline.poses[i];
        const double t = share / 20.0;
        nearest =
            std::min(nearest, std::hypot(p[0] - a[0] - t * (b[0] - a[0]), p[1] - a[1] - t * (b[1] - a[1])));
      }
    EXPECT_LE(nearest, 0.05);  // the samples' distance
  }
  EXPECT_NEAR(nurbs.poses.back()[0], 30, 1e-9);
}

TEST(Nurbs, LinesStayWithinTheFlatness) {
  Nurbs curve;
  curve.order = 5;
  for (int i = 0; i < 40; ++i) {
    curve.points.push_back({i * 3.0, 20 * std::sin(i * 1.3), 5 * std::cos(i * 0.7), i * 0.1});
    curve.weights.push_back(1 + 0.9 * std::sin(i * 2.1));
  }
  curve.set_even_knots();
  ASSERT_TRUE(curve.is_clamped());
  std::vector<Nurbs::Point> ends;
  ASSERT_TRUE(flatten(curve, kSplineFlatness_mm, 100'000, ends));
  ends.insert(ends.begin(), curve.points.front());
  EXPECT_EQ(ends.back(), curve.points.back());
  double most = 0;
  std::size_t at = 1;
  const double last = curve.knots.back();
  for (int i = 0; i <= 400'000; ++i) {
    const auto p = curve.at(last * i / 400'000);
    const auto off = [&](std::size_t piece) {
      double along = 0, length = 0, square = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        along += (p[k] - ends[piece - 1][k]) * (ends[piece][k] - ends[piece - 1][k]);
        length += (ends[piece][k] - ends[piece - 1][k]) * (ends[piece][k] - ends[piece - 1][k]);
      }
      const double share = std::clamp(along / length, 0.0, 1.0);
      for (std::size_t k = 0; k < 4; ++k) {
        const double d = p[k] - ends[piece - 1][k] - share * (ends[piece][k] - ends[piece - 1][k]);
        square += d * d;
      }
      return std::sqrt(square);
    };
    while (at + 1 < ends.size() && off(at + 1) < off(at)) ++at;
    most = std::max(most, off(at));
  }
  EXPECT_LE(most, 1.3 * kSplineFlatness_mm);  // three places of each piece were looked at
}

TEST(Nurbs, ExtrusionGoesAlong) {
  const Read vase = read("G5.2 L3\nX5 Y10 Z0.1 E1\nX10 Y0 Z0.2 E2\nG5.3\n");
  ASSERT_EQ(vase.error, "");
  for (std::size_t i = 1; i < vase.poses.size(); ++i)
    EXPECT_GT(vase.poses[i][kAxisE], vase.poses[i - 1][kAxisE]);
  EXPECT_NEAR(vase.poses.back()[kAxisE], 2, 1e-9);
  EXPECT_NEAR(vase.poses.back()[2], 0.2, 1e-9);
}

TEST(Nurbs, WhatIsWrongIsRefusedAndChangesNothing) {
  EXPECT_EQ(read("G5.3\n").error, "1:1: G5.3 ends a NURBS, and none has begun");
  EXPECT_EQ(read("G5.2 X1 Y1\nG5.3\n").error, "2:1: a NURBS of order 3 needs as many points, and has 2");
  EXPECT_EQ(read("G5.2 X1 Y1\nG1 X5\n").error,
            "2:1: the NURBS that G5.2 began has no end: write G5.3 before this line");
  EXPECT_EQ(read("G5.2 X1 Y1\nX2\n").error,
            "2:1: the NURBS that G5.2 began has no end: write G5.3 before this line");
  EXPECT_EQ(read("G6.2 P3 K0 X1 Y0\n").error,
            "1:1: the first control point of G6.2 must be where the tool stands");
  EXPECT_EQ(read("G6.2 P2 K0 X0\nK0 X1\nK-1\n").error, "3:1: the knots K of a NURBS cannot fall");
  EXPECT_EQ(read("G6.2 P2 K0 X0\nK0 X1\nK1\nK1 X2\n").error,
            "4:1: a line with K alone came before: no more points can follow");
  EXPECT_EQ(
      read("G6.2 P2 K0 X0\nK1 X1\nK1\nK2\n").error,
      "4:1: the knots K have to begin and end with as many equal ones as the order P, and to have fewer "
      "equal ones between");
  EXPECT_EQ(read("G5.2 X1 P0\n").error, "1:9: the weight P of a control point is 0.000001 to 1000000");

  // The lines of a host go on behind a refused one.
  Interpreter interpreter([] {
    Options options;
    options.default_feed_mm_per_s = 10;
    return options;
  }());
  CommandBuffer out;
  ASSERT_TRUE(interpreter.execute("G5.2 L3 X0 Y10", 1, out));
  ASSERT_FALSE(interpreter.execute("X1 Y99 P1 R7", 2, out));
  ASSERT_TRUE(interpreter.execute("X10 Y10", 3, out));
  ASSERT_TRUE(interpreter.execute("G5.3", 4, out));
  for (const canonical::Line& line : out)
    if (const auto* feed = std::get_if<canonical::Feed>(&line.command)) {
      EXPECT_LE(feed->target[1], 10);
    }
  EXPECT_FALSE(interpreter.in_nurbs());
}

}  // namespace
}  // namespace kinebus::gcode
