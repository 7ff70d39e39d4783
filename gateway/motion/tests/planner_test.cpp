#include "gateway/motion/planner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "gateway/kinematics/geometry.hpp"
#include "gateway/motion/tests/time_optimal.hpp"
#include "gateway/motion/tests/trajectory_probe.hpp"

namespace kinebus::probe {
namespace {

constexpr double kPi = std::numbers::pi;

const Kinematics& m1() {
  static const auto machine = make_m1_kinematics(M1Geometry{});
  return **machine;
}

void expect_within_limits(const Measured& m, const MotionLimits& limits, double tolerance_mm) {
  ASSERT_TRUE(m.planned) << m.error;
  EXPECT_LE(m.tool_speed_mm_per_s, limits.tool_speed_mm_per_s * (1 + 1e-6));
  EXPECT_LE(m.tool_accel_mm_per_s2, limits.tool_accel_mm_per_s2 * (1 + 1e-6));
  EXPECT_LE(m.joint_speed_ratio, 0.99);
  EXPECT_LE(m.joint_accel_ratio, 0.99);
  EXPECT_LE(m.axis_speed_ratio, 1 + 1e-6);
  EXPECT_LE(m.axis_accel_ratio, 1 + 1e-6);
  EXPECT_LE(m.path_error_mm, tolerance_mm) << "line " << m.path_error_line;
  EXPECT_LE(m.position_jump, 1e-8);
  EXPECT_LE(m.velocity_jump, 1e-6);
  EXPECT_LE(m.speed_at_ends, 1e-6);
  EXPECT_LE(m.end_error, 1e-8);
  EXPECT_TRUE(m.last_marked);
}

void print(const char* what, const Measured& m) {
  std::printf(
      "%s: %.3f s, %zu phases, %lu moves (%lu merged), %lu pieces, v %.1f a %.1f joint v %.3f a %.3f axis v "
      "%.3f a %.3f "
      "path %.2f um, jump %.2g %.2g, %s\n",
      what, m.duration_s, m.phases, m.counters.moves, m.counters.merged_moves, m.counters.pieces,
      m.tool_speed_mm_per_s, m.tool_accel_mm_per_s2, m.joint_speed_ratio, m.joint_accel_ratio,
      m.axis_speed_ratio, m.axis_accel_ratio, m.path_error_mm * 1000, m.position_jump, m.velocity_jump,
      m.error.c_str());
}

TEST(Planner, LineFromRestToRestIsATrapezoid) {
  const MotionLimits limits;
  const Measured m = measure(m1(), limits, Job().feed(100).to({50, 0, 0, 0, 0, 0}).lines());
  expect_within_limits(m, limits, 1e-9);
  print("line", m);
  EXPECT_EQ(m.phases, 3u);
  EXPECT_NEAR(m.duration_s, 50.0 / 100 + 100.0 / 3000, 1e-9);
}

TEST(Planner, Square) {
  const MotionLimits limits;
  Job job;
  job.feed(100)
      .by({20, 0, 0, 0, 0, 1})
      .by({0, 20, 0, 0, 0, 1})
      .by({-20, 0, 0, 0, 0, 1})
      .by({0, -20, 0, 0, 0, 1});
  const Measured m = measure(m1(), limits, job.lines());
  expect_within_limits(m, limits, 0.005);
  print("square", m);
}

TEST(Planner, Dense) {
  const MotionLimits limits;
  Measured m = measure(m1(), limits, dense_curve(20000, 30, 100, 0, 0));
  expect_within_limits(m, limits, 0.005);
  print("dense", m);
  m = measure(m1(), limits, dense_curve(20000, 30, 100, 0.5, 1));
  expect_within_limits(m, limits, 0.005);
  print("dense5", m);
}

TEST(Planner, Optimal) {
  const MotionLimits limits;
  const auto ratio = [&](const char* what, const Lines& lines, double feed, double grid) {
    const Measured m = measure(m1(), limits, lines, 8, true);
    const double best = time_optimal_s(m1(), limits, m.all, feed, grid);
    print(what, m);
    std::printf("   %.3f s, optimal %.3f s, ratio %.4f\n", m.duration_s, best, m.duration_s / best);
  };
  Job job;
  job.feed(1000)
      .by({20, 0, 0, 0, 0, 1})
      .by({0, 20, 0, 0, 0, 1})
      .by({-20, 0, 0, 0, 0, 1})
      .by({0, -20, 0, 0, 0, 1});
  ratio("square", job.lines(), 1000, 0.02);
  ratio("dense 100", dense_curve(3000, 30, 100, 0, 0), 100, 0.02);
  ratio("dense 300", dense_curve(3000, 30, 300, 0, 0), 300, 0.02);
  ratio("dense small 300", dense_curve(3000, 5, 300, 0, 0), 300, 0.02);
  ratio("tilted 100", dense_curve(3000, 30, 100, 0.5, 1), 100, 0.02);
  ratio("tilted 300", dense_curve(3000, 30, 300, 0.5, 1), 300, 0.02);
  ratio("tilted 60 100", dense_curve(3000, 60, 300, 0.7, 1), 300, 0.02);
  for (const double f : {50., 100., 1000.}) {
    Lines print = random_print(7, 2000);
    for (auto& line : print)
      if (auto* feed = std::get_if<canonical::Feed>(&line.command)) feed->feed_per_s = f;
    ratio("print", print, f, 0.02);
  }
}

TEST(Planner, Random) {
  const MotionLimits limits;
  for (int seed = 0; seed < 10; ++seed) {
    const Measured m = measure(m1(), limits, random_print(static_cast<std::uint64_t>(seed), 3000), 8);
    expect_within_limits(m, limits, 0.005);
    print("random", m);
  }
}

}  // namespace
}  // namespace kinebus::probe
