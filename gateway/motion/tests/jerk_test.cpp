// Plans with limited jerk, measured from outside.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "gateway/kinematics/geometry.hpp"
#include "gateway/motion/planner.hpp"
#include "gateway/motion/speed_ramp.hpp"
#include "gateway/motion/start_ramp.hpp"
#include "gateway/motion/tests/test_machine.hpp"
#include "gateway/motion/tests/trajectory_probe.hpp"

namespace kinebus::probe {
namespace {

MotionLimits jerk_limits(double jerk = 100'000) {
  MotionLimits limits;
  limits.tool_jerk_mm_per_s3 = jerk;
  for (std::size_t j = 0; j < kMaxJoints; ++j)
    limits.joint_jerk_per_s3[j] = jerk * limits.joint_accel_per_s2[j] / limits.tool_accel_mm_per_s2;
  return limits;
}

void expect_smooth(const Measured& m, const MotionLimits& limits, double tolerance_mm) {
  expect_within_limits(m, limits, tolerance_mm);
  EXPECT_LE(m.tool_jerk_mm_per_s3, limits.tool_jerk_mm_per_s3);
  EXPECT_LE(m.joint_jerk_ratio, 1);
  EXPECT_LE(m.accel_jump_mm_per_s2, limits.tool_jerk_mm_per_s3 * kCurvatureJump_s * 1.001);
}

TEST(SpeedRamp, KeepsItsBoundsAndJoinsItsEnds) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-3, 3);
  for (int i = 0; i < 20'000; ++i) {
    const auto draw = [&] { return std::pow(10, exponent(random)); };
    const double from = i % 7 == 0 ? 0 : draw(), to = i % 11 == 0 ? 0 : i % 5 == 0 ? from : draw();
    const double accel = 100 * draw(), jerk = 1000 * draw();
    const SpeedRamp ramp(from, to, accel, jerk);
    double s = 0, t = 0, v = from, a = 0;
    for (int k = 0; k < SpeedRamp::kStages; ++k) {
      const SpeedRamp::Stage stage = ramp.stage(k);
      const double scale = std::max({from, to, 1e-9});
      EXPECT_NEAR(stage.speed, v, 1e-9 * scale);
      EXPECT_NEAR(stage.accel, a, 1e-9 * accel);
      EXPECT_LE(std::abs(stage.jerk), jerk * (1 + 1e-12));
      EXPECT_LE(std::abs(stage.accel), accel * (1 + 1e-12));
      EXPECT_GE(stage.duration_s, -1e-12 * ramp.duration_s());
      v = stage.speed_at(stage.duration_s);
      a = stage.accel + stage.jerk * stage.duration_s;
      const double way = stage.way(stage.duration_s);
      const double part = stage.time_of(0.3 * way);
      EXPECT_NEAR(stage.way(part), 0.3 * way, 1e-12 * (way + 1e-12));
      EXPECT_LE(part, stage.duration_s);
      s += way;
      t += stage.duration_s;
    }
    EXPECT_NEAR(v, to, 1e-9 * std::max(from, to));
    EXPECT_NEAR(a, 0, 1e-9 * accel);
    EXPECT_NEAR(s, ramp.length(), 1e-9 * ramp.length());
    EXPECT_NEAR(t, ramp.duration_s(), 1e-12 * t);
  }
}

TEST(JerkLimit, LineFromRestToRestTakesTheTimeOfTheFormula) {
  const MotionLimits limits = jerk_limits();
  const Measured m = measure(m1(), limits, Job().feed(100).to({50, 0, 0, 0, 0, 0}).lines());
  expect_smooth(m, limits, 1e-9);
  // Jerk and acceleration are planned to 0.96 of the jerk limit: v / a + a / j for either ramp.
  EXPECT_NEAR(m.duration_s, 50.0 / 100 + 100.0 / 3000 + 3000 / 96'000.0, 1e-3);
}

TEST(JerkLimit, ShortLineNeitherReachesItsSpeedNorAFullAcceleration) {
  const MotionLimits limits = jerk_limits();
  const Measured m = measure(m1(), limits, Job().feed(100).to({1, 0, 0, 0, 0, 0}).lines());
  expect_smooth(m, limits, 1e-9);
  // Four jerk phases of t: j t^3 * 2 = 1 mm.
  EXPECT_NEAR(m.duration_s, 4 * std::cbrt(1 / (2 * 96'000.0)), 1e-4);
}

TEST(JerkLimit, Corners) {
  const MotionLimits limits = jerk_limits();
  Job job;
  job.feed(100);
  for (int i = 0; i < 20; ++i)
    job.by({5.0 + i, 0, 0, 0, 0, 0.1}).by({0, 0.1 * i, 0, 0, 0, 0.1}).by({-5.0 - i, 0.5, 0, 0, 0, 0});
  expect_smooth(measure(m1(), limits, job.lines()), limits, 0.005);
}

TEST(JerkLimit, Arcs) {
  const MotionLimits limits = jerk_limits();
  Job job;
  job.feed(60)
      .to({20, 0, 0, 0, 0, 0})
      .arc({20, 20, 0, 0, 0, 1}, {20, 10, 0}, {0, 0, 1}, 3.14159265358979)
      .to({-20, 20, 0, 0, 0, 1});
  expect_smooth(measure(m1(), limits, job.lines()), limits, 0.005);
}

TEST(JerkLimit, Prints) {
  for (const double jerk : {20'000.0, 100'000.0, 1e6})
    for (const std::uint64_t seed : {1, 2, 3}) {
      SCOPED_TRACE(seed);
      const MotionLimits limits = jerk_limits(jerk);
      expect_smooth(measure(m1(), limits, random_print(seed, 3000)), limits, 0.01);
    }
}

TEST(JerkLimit, DenseCurves) {
  const MotionLimits limits = jerk_limits();
  expect_smooth(measure(m1(), limits, dense_curve(3000, 40, 100, 0, 0)), limits, 0.005);
  expect_smooth(measure(m1(), limits, dense_curve(3000, 40, 60, 0.3, 1)), limits, 0.005);
  expect_smooth(measure(m1(), limits, dense_curve(3000, 30, 100, 0.5, 1)), limits, 0.005);
}

/// The curvature of merged curves jumps where they join, and the joints' accelerations with it: ramps that
/// meet there have to leave room for the jump.
TEST(JerkLimit, RandomCurvesKeepTheJointsJerkOnEveryMachine) {
  const auto delta = *make_linear_delta_kinematics({});
  const auto table = *make_cartesian_kinematics({.has_table = true});
  const std::vector<std::pair<const Kinematics*, double>> machines{
      {&m1(), 0.5}, {table.get(), 0}, {delta.get(), 0}};
  for (unsigned seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const auto draw = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto& [machine, tilt] = machines[seed % machines.size()];
    const double turn = machine == delta.get() ? 0 : draw(0, 2);
    const MotionLimits limits = jerk_limits(std::exp(draw(std::log(2e4), std::log(5e5))));
    const double size_mm = draw(5, 40), feed = draw(40, 200);
    const Measured m =
        measure(*machine, limits,
                dense_curve(static_cast<int>(draw(600, 1500)), size_mm, feed, tilt * draw(0, 1), turn));
    expect_smooth(m, limits, 0.005);
  }
}

TEST(JerkLimit, FiveAxes) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    SCOPED_TRACE(seed);
    const MotionLimits limits = jerk_limits();
    for (const Frame frame : {Frame::kPart, Frame::kMachine})
      expect_smooth(measure(m1(), limits, random_five_axis(seed, 800, frame)), limits, 0.02);
  }
}

TEST(JerkLimit, SmallWindowsAreSafe) {
  const MotionLimits limits = jerk_limits();
  for (const std::size_t window : {8, 20, 60, 200}) {
    SCOPED_TRACE(window);
    expect_smooth(measure(m1(), limits, random_print(5, 1500), 8, false, {.window_pieces = window}), limits,
                  0.01);
  }
}

TEST(JerkLimit, LinesThatComeOneByOneJoinSmoothlyAndEndAtRest) {
  const MotionLimits limits = jerk_limits();
  Planner planner(m1(), limits);
  Pose end{};
  Phase phase;
  double speed = 0, accel = 0, planned_s = 0, seen_s = 0;
  bool first = true, last = false;
  const auto pull = [&] {
    while (planner.next(phase)) {
      const PosePoint start = phase.at(0);
      if (std::exchange(first, false)) end = start.x;
      for (std::size_t i = 0; i < kPoseAxes; ++i) EXPECT_NEAR(start.x[i], end[i], 1e-7);
      EXPECT_NEAR(phase.v0, speed, 1e-6);
      EXPECT_NEAR(phase.a, accel, 1e-3);
      end = phase.at(phase.duration_s).x;
      speed = phase.speed(phase.duration_s);
      accel = phase.accel(phase.duration_s);
      planned_s += phase.duration_s;
      last = phase.last;
    }
  };
  for (const auto& line : random_print(9, 400)) {
    ASSERT_TRUE(planner.add(line));
    planner.plan_known();
    const Planner::Ahead ahead = planner.ahead();
    EXPECT_LE(ahead.final_s, ahead.all_s + 1e-9);
    seen_s = planned_s + ahead.all_s;
    pull();
  }
  ASSERT_TRUE(planner.finish());
  pull();
  EXPECT_TRUE(planner.idle());
  EXPECT_TRUE(last);
  EXPECT_NEAR(speed, 0, 1e-6);
  EXPECT_NEAR(seen_s, planned_s, 0.2);
  for (std::size_t i = 0; i < kPoseAxes; ++i) EXPECT_NEAR(end[i], planner.end_pose()[i], 1e-8);
}

TEST(JerkLimit, MoreThanWasFinishedStartsFromRest) {
  Planner planner(m1(), jerk_limits());
  Phase phase;
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(planner.add(
        {static_cast<std::uint32_t>(i), canonical::Feed{{10.0 * i, 0, 0, 0, 0, 0}, Frame::kMachine, 50, 0}}));
    ASSERT_TRUE(planner.finish());
    bool first = true, last = false;
    while (planner.next(phase)) {
      if (first) {
        EXPECT_EQ(phase.v0, 0);
      }
      EXPECT_FALSE(last);
      first = false;
      last = phase.last;
    }
    EXPECT_TRUE(last);
    EXPECT_NEAR(phase.at(phase.duration_s).x[kX], 10.0 * i, 1e-9);
  }
}

TEST(JerkLimit, ThePlaceInAPhaseIsFoundByItsPathParameter) {
  const Measured m = measure(m1(), jerk_limits(), random_print(2, 50), 8, true);
  for (const Phase& phase : m.all)
    for (const double share : {0.0, 0.2, 0.5, 0.99, 1.0}) {
      const double t = share * phase.duration_s;
      EXPECT_NEAR(phase.s(time_at(phase, phase.s(t))), phase.s(t), 1e-9);
    }
}

TEST(JerkLimit, AMotionThatBeginsInItsMidstFollowsTheSamePath) {
  const Measured m = measure(m1(), jerk_limits(), random_print(4, 200), 8, true);
  const std::size_t from = m.all.size() / 2;
  StartRamp ramp;
  ramp.start(0.2);
  std::vector<Phase> out;
  ramp.apply(m.all[from], 0.5 * m.all[from].duration_s, out);
  for (std::size_t i = from + 1; i < m.all.size(); ++i) ramp.apply(m.all[i], 0, out);
  ASSERT_FALSE(out.empty());
  EXPECT_FALSE(ramp.active());
  EXPECT_EQ(out.front().v0, 0);
  for (std::size_t i = 1; i < out.size(); ++i) {
    const PosePoint before = out[i - 1].at(out[i - 1].duration_s), after = out[i].at(0);
    for (std::size_t k = 0; k < kPoseAxes; ++k) {
      EXPECT_NEAR(before.x[k], after.x[k], 1e-7);
      EXPECT_NEAR(before.x1[k], after.x1[k], 1e-3);
    }
  }
}

}  // namespace
}  // namespace kinebus::probe
