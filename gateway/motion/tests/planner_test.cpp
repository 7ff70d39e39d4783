#include "gateway/motion/planner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "gateway/motion/tests/test_machine.hpp"
#include "gateway/motion/tests/trajectory_probe.hpp"

namespace kinebus::probe {
namespace {

constexpr double kPi = std::numbers::pi;
const MotionLimits kLimits;

TEST(Planner, LineFromRestToRestIsATrapezoid) {
  const Measured m = measure(m1(), kLimits, Job().feed(100).to({50, 0, 0, 0, 0, 0}).lines());
  expect_within_limits(m, kLimits, 1e-9);
  EXPECT_EQ(m.phases, 3u);
  EXPECT_NEAR(m.duration_s, 50.0 / 100 + 100.0 / 3000, 1e-9);
}

TEST(Planner, ShortLineIsATriangle) {
  const Measured m = measure(m1(), kLimits, Job().feed(100).to({1, 0, 0, 0, 0, 0}).lines());
  expect_within_limits(m, kLimits, 1e-9);
  EXPECT_EQ(m.phases, 2u);
  EXPECT_NEAR(m.duration_s, 2 * std::sqrt(1.0 / 3000), 1e-9);
}

TEST(Planner, TraverseRunsAtTheToolLimit) {
  const Measured m =
      measure(m1(), kLimits, Job().rapid({50, 30, 20, 0, 0, 0}).rapid({-50, 30, 20, 0, 0, 0}).lines());
  expect_within_limits(m, kLimits, 0.005);
  EXPECT_NEAR(m.tool_speed_mm_per_s, 300, 1e-6);
}

// A blend of 5 um in a right angle: b = 4 * 5 um / sqrt(2), v^2 = 2 b A / sqrt(2).
TEST(Planner, RightAngleIsPassedAtTheSpeedThatTheToleranceAllows) {
  const Measured m = measure(
      m1(), kLimits, Job().feed(100).by({20, 0, 0, 0, 0, 0}).by({0, 20, 0, 0, 0, 0}).lines(), 8, true);
  expect_within_limits(m, kLimits, 0.005);
  double slowest = 1e9;
  for (std::size_t i = 1; i < m.all.size(); ++i) slowest = std::min(slowest, m.all[i].v0);
  EXPECT_NEAR(slowest, std::sqrt(2 * (4 * 0.005 / std::sqrt(2.0)) * 3000 / std::sqrt(2.0)), 1e-6);
  EXPECT_GT(m.path_error_mm, 0.0035);
}

TEST(Planner, ToleranceOfG64IsUsed) {
  Job job;
  job.add(canonical::PathMode{false, 0.05}).feed(100).by({20, 0, 0, 0, 0, 0}).by({0, 20, 0, 0, 0, 0});
  const Measured m = measure(m1(), kLimits, job.lines());
  expect_within_limits(m, kLimits, 0.05);
  EXPECT_GT(m.path_error_mm, 0.02);
}

TEST(Planner, MergeToleranceOfG64IsUsedAndKept) {
  const auto with = [](const canonical::PathMode& mode) {
    Lines lines = dense_curve(2000, 30, 100, 0, 0);
    lines.insert(lines.begin() + 1, {0, mode});
    return measure(m1(), kLimits, lines);
  };
  const Measured wide = with({false, 0.005, 0.1}), tight = with({false, 0.1, 0.002});
  expect_within_limits(wide, kLimits, 0.1);
  EXPECT_GT(wide.path_error_mm, 0.01);
  EXPECT_EQ(wide.counters.merged_moves, 2000u);
  expect_within_limits(tight, kLimits, 0.1);
  EXPECT_LT(tight.path_error_mm, wide.path_error_mm);
  EXPECT_EQ(with({false, 0.005, 0, false}).counters.merged_moves, 0u);
}

TEST(Planner, TraverseSpeedIsThatOfTheTool) {
  MotionLimits limits;
  limits.traverse_mm_per_s = 120;
  const Measured m =
      measure(m1(), limits, Job().rapid({50, 30, 20, 0, 0, 0.5}).rapid({-50, 30, 20, 0, 0, 0}).lines());
  expect_within_limits(m, limits, 0.005);
  EXPECT_NEAR(m.tool_speed_mm_per_s, 120, 1e-6);
  // An F with G0 slows it down, and does not speed it up.
  for (const auto& [asked, speed] : {std::pair{50.0, 50.0}, std::pair{200.0, 120.0}}) {
    Lines lines = Job().rapid({50, 30, 20, 0, 0, 0}).rapid({-50, 30, 20, 0, 0, 0}).lines();
    for (canonical::Line& line : lines)
      if (auto* traverse = std::get_if<canonical::Traverse>(&line.command)) traverse->speed_per_s = asked;
    EXPECT_NEAR(measure(m1(), limits, lines).tool_speed_mm_per_s, speed, 1e-6) << asked;
  }
}

TEST(Planner, ExactPathStaysOnThePath) {
  Lines lines = random_print(3, 1500);
  lines.insert(lines.begin() + 1, {0, canonical::PathMode{true, 0}});
  const Measured m = measure(m1(), kLimits, lines, 32);
  expect_within_limits(m, kLimits, kLimits.exact_tolerance_mm * (1 + 1e-6));
  EXPECT_EQ(m.counters.merged_moves, 0u);
}

TEST(Planner, PrintsKeepEveryLimitAndThePath) {
  for (std::uint64_t seed = 100; seed < 108; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << " of random_print");
    expect_within_limits(measure(m1(), kLimits, random_print(seed, 2000)), kLimits, 0.005);
  }
}

TEST(Planner, FiveAxisMotionKeepsEveryLimitAndThePath) {
  for (std::uint64_t seed = 200; seed < 220; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << " of random_five_axis");
    const Frame frame = seed % 2 == 0 ? Frame::kPart : Frame::kMachine;
    expect_within_limits(measure(m1(), kLimits, random_five_axis(seed, 1000, frame), 16), kLimits, 0.005);
  }
}

TEST(Planner, TightJointLimitsAreKept) {
  MotionLimits limits;
  for (std::size_t j = 0; j < 4; ++j) {
    limits.joint_speed_per_s[j] = 60;
    limits.joint_accel_per_s2[j] = 800;
  }
  for (std::uint64_t seed = 300; seed < 306; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << " of random_five_axis");
    const Frame frame = seed % 2 == 0 ? Frame::kPart : Frame::kMachine;
    const Measured m = measure(m1(), limits, random_five_axis(seed, 1000, frame), 16);
    expect_within_limits(m, limits, 0.005);
    EXPECT_GT(m.joint_accel_ratio, 0.97);
  }
}

TEST(Planner, CartesianMachineWorksTheSame) {
  CartesianGeometry geometry;
  geometry.x_mm = geometry.y_mm = geometry.z_mm = {};
  const auto machine = make_cartesian_kinematics(geometry);
  ASSERT_TRUE(machine);
  for (std::uint64_t seed = 400; seed < 403; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << " of random_print");
    expect_within_limits(measure(**machine, kLimits, random_print(seed, 1500)), kLimits, 0.005);
  }
}

TEST(Planner, DenseCurveBecomesPiecesOfSeveralMillimetres) {
  const Measured m = measure(m1(), kLimits, dense_curve(10000, 30, 100, 0, 0));
  expect_within_limits(m, kLimits, 0.005);
  EXPECT_EQ(m.counters.merged_moves, 10000u);
  EXPECT_LT(static_cast<double>(m.phases), 10000 * 0.2 / 4) << "phases of less than 4 mm on average";
  EXPECT_NEAR(m.duration_s, 10000 * 0.2 / 100, 0.1);
}

TEST(Planner, TiltedDenseCurveKeepsEveryLimit) {
  const Measured m = measure(m1(), kLimits, dense_curve(10000, 30, 150, 0.5, 1));
  expect_within_limits(m, kLimits, 0.005);
  EXPECT_EQ(m.counters.merged_moves, 10000u);
}

TEST(Planner, ArcStaysAnArc) {
  const double r = 20;
  Job job({r, 0, 10, 0, 0, 0});
  job.feed(100).arc({r, 0, 10, 0, 0, 5}, {0, 0, 10}, {0, 0, 1}, 2 * kPi);
  const Measured m = measure(m1(), kLimits, job.lines());
  expect_within_limits(m, kLimits, 1e-9);
  EXPECT_NEAR(m.duration_s, 2 * kPi * r / 100 + 100.0 / 3000, 0.01);
}

TEST(Planner, ArcsSpeedIsSetByItsCurvature) {
  Job job({2, 0, 10, 0, 0, 0});
  job.feed(200).arc({2, 0, 10, 0, 0, 0}, {0, 0, 10}, {0, 0, 1}, 10 * kPi);
  const Measured m = measure(m1(), kLimits, job.lines());
  expect_within_limits(m, kLimits, 1e-9);
  EXPECT_NEAR(m.tool_speed_mm_per_s, std::sqrt(3000 * 2.0), 0.1);
}

TEST(Planner, LineRunsIntoTangentialArcWithoutStopping) {
  Job job({-20, -10, 0, 0, 0, 0});
  job.feed(100)
      .to({0, -10, 0, 0, 0, 0})
      .arc({0, 10, 0, 0, 0, 0}, {0, 0, 0}, {0, 0, 1}, kPi)
      .to({-20, 10, 0, 0, 0, 0});
  const Measured m = measure(m1(), kLimits, job.lines());
  expect_within_limits(m, kLimits, 0.005);
  EXPECT_NEAR(m.duration_s, (40 + 10 * kPi) / 100 + 100.0 / 3000, 0.01);
}

TEST(Planner, KinkBetweenArcsIsBlendedWithinTolerance) {
  Job job({0, 0, 0, 0, 0, 0});
  job.feed(100);
  for (int i = 0; i < 4; ++i) {  // half circles of 0.5 and 8 mm, with kinks of 90 and 180 degrees
    const Pose at = job.at();
    job.arc({at[0] + 16, at[1], 0, 0, 0, 0}, {at[0] + 8, at[1], 0}, {0, 0, 1}, kPi);
    job.arc({at[0] + 15, at[1], 0, 0, 0, 0}, {at[0] + 15.5, at[1], 0}, {0, 0, 1}, kPi);
    job.by({0, 3, 0, 0, 0, 0});
  }
  expect_within_limits(measure(m1(), kLimits, job.lines(), 64), kLimits, 0.005);
}

TEST(Planner, FilamentNeverSteps) {
  Job job;
  job.feed(60)
      .by({30, 0, 0, 0, 0, 1.2})
      .by({30, 0, 0, 0, 0, 0})
      .by({0, 0, 0, 0, 0, -0.8})
      .by({0, 0, 0, 0, 0, 0.8});
  job.by({0, 20, 0, 0, 0, 0.8});
  const Measured m = measure(m1(), kLimits, job.lines(), 32);
  expect_within_limits(m, kLimits, 0.005);
}

TEST(Planner, InverseTimeMoveTakesItsTime) {
  Job job;
  const Pose target{10, 0, 0, 0.1, 0.3, 0};
  job.add(canonical::Feed{target, Frame::kPart, 0, 4.0});
  EXPECT_NEAR(measure(m1(), kLimits, job.lines()).duration_s, 4.0, 0.01);
}

TEST(Planner, RotaryMoveRunsAtItsOwnFeed) {
  Job job;
  job.feed(0.5).by({0, 0, 0, 0, 2, 0});
  const Measured m = measure(m1(), kLimits, job.lines());
  expect_within_limits(m, kLimits, 1e-9);
  EXPECT_NEAR(m.duration_s, 4 + 0.5 / 61, 0.005);
}

// In the machine frame the table turns away under a tool that moves in X: the tip's speed on the part is
// more.
TEST(Planner, FeedIsTheTipsSpeedOnATurningPart) {
  Job job({30, 0, 0, 0, 0, 0}, Frame::kMachine);
  job.feed(20).to({50, 0, 0, 0, 1, 0});
  const Measured m = measure(m1(), kLimits, job.lines(), 64, true);
  expect_within_limits(m, kLimits, 1e-9);
  double fastest = 0;
  for (const Phase& phase : m.all) {
    for (int i = 0; i <= 64; ++i) {
      const PosePoint p = phase.at(phase.duration_s * i / 64);
      // q = R_Z(-C) m, with A = 0.
      const double wx = p.x1[kX] + p.x1[kC] * p.x[kY], wy = p.x1[kY] - p.x1[kC] * p.x[kX];
      fastest = std::max(fastest, std::hypot(wx, wy));
    }
  }
  EXPECT_LE(fastest, 20 * 1.001);
  EXPECT_GE(fastest, 20 * 0.99);
}

TEST(Planner, JobsAccelerationsAreKept) {
  Job job;
  canonical::Limits asked;
  asked.print_accel_mm_per_s2 = 500;
  job.add(asked).feed(100).by({30, 0, 0, 0, 0, 1}).by({0, 30, 0, 0, 0, 1});
  EXPECT_NEAR(measure(m1(), kLimits, job.lines()).tool_accel_mm_per_s2, 500, 1e-6);
}

TEST(Planner, JobCannotRaiseTheMachinesLimits) {
  Job job;
  canonical::Limits asked;
  asked.print_accel_mm_per_s2 = asked.travel_accel_mm_per_s2 = 90000;
  asked.axis_accel_per_s2.fill(90000);
  asked.axis_speed_per_s.fill(9000);
  job.add(asked).rapid({50, 0, 0, 0, 1, 0}).feed(500).by({30, 0, 0, 0, 3, 1});
  expect_within_limits(measure(m1(), kLimits, job.lines()), kLimits, 0.005);
}

TEST(Planner, AxisLimitsOfTheJobAreKept) {
  Lines lines = random_print(5, 800);
  canonical::Limits asked;
  asked.axis_speed_per_s = {60, 40, 0, 0, 0, 20};
  asked.axis_accel_per_s2 = {700, 900, 0, 0, 0, 500};
  lines.insert(lines.begin() + 1, {0, asked});
  MotionLimits limits;
  limits.axis_speed_per_s = {60, 40, kUnlimited, 1, 1, 20};
  limits.axis_accel_per_s2 = {700, 900, kUnlimited, 30, 60, 500};
  expect_within_limits(measure(m1(), limits, lines), limits, 0.005);
}

TEST(Planner, FeedOverrideScalesTheFeed) {
  Job job;
  job.add(canonical::Override{0.5, 0}).feed(100).by({50, 0, 0, 0, 0, 0});
  EXPECT_NEAR(measure(m1(), kLimits, job.lines()).tool_speed_mm_per_s, 50, 1e-6);
}

TEST(Planner, FrameChangesAtRest) {
  Job job;
  job.feed(100).by({10, 0, 0, 0, 0, 0});
  job.add(canonical::SetPosition{{10, 0, 0, 0, 0, 0}, Frame::kMachine});
  job.add(canonical::Feed{{20, 0, 0, 0, 0, 0}, Frame::kMachine, 100, 0});
  const Measured m = measure(m1(), kLimits, job.lines(), 8, true);
  expect_within_limits(m, kLimits, 1e-9);
  EXPECT_NEAR(m.duration_s, 2 * (10.0 / 100 + 100.0 / 3000), 1e-9);
}

TEST(Planner, MoveInAnotherFrameIsRefused) {
  Planner planner(m1(), kLimits);
  const auto refused = planner.add({7, canonical::Feed{{1, 0, 0, 0, 0, 0}, Frame::kPart, 10, 0}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, PlanError::Kind::kFrame);
  EXPECT_EQ(refused.error().line, 7u);
  EXPECT_NE(to_string(refused.error()).find("line 7"), std::string::npos);
}

TEST(Planner, UnreachableMoveIsRefusedWithItsLineUntilReset) {
  Planner planner(m1(), kLimits);
  planner.reset({}, Frame::kPart);
  const Frame part = Frame::kPart;
  ASSERT_TRUE(planner.add({1, canonical::Feed{{10, 0, 0, 0, 0, 0}, part, 100, 0}}));
  auto result = planner.add({2, canonical::Feed{{2000, 0, 0, 0, 0, 0}, part, 100, 0}});
  if (result) result = planner.finish();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, PlanError::Kind::kPose);
  EXPECT_EQ(result.error().line, 2u);
  EXPECT_FALSE(planner.add({3, canonical::Feed{{0, 0, 0, 0, 0, 0}, part, 100, 0}}));
  planner.reset({10, 0, 0, 0, 0, 0}, Frame::kPart);
  EXPECT_TRUE(planner.add({4, canonical::Feed{{0, 0, 0, 0, 0, 0}, part, 100, 0}}));
  EXPECT_TRUE(planner.finish());
}

TEST(Planner, NonsenseIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Frame machine = Frame::kMachine;
  const auto kind = [&](const canonical::Command& command) {
    Planner planner(m1(), kLimits);
    const auto result = planner.add({1, command});
    EXPECT_FALSE(result);
    return result ? PlanError::Kind::kPose : result.error().kind;
  };
  EXPECT_EQ(kind(canonical::Feed{{nan, 0, 0, 0, 0, 0}, machine, 10, 0}), PlanError::Kind::kBadNumber);
  EXPECT_EQ(kind(canonical::Feed{{1, 0, 0, 0, 0, 0}, machine, 0, 0}), PlanError::Kind::kBadNumber);
  EXPECT_EQ(kind(canonical::Feed{{1, 0, 0, 0, 0, 0}, machine, nan, 0}), PlanError::Kind::kBadNumber);
  EXPECT_EQ(kind(canonical::Arc{{1, 0, 0, 0, 0, 0}, machine, {0, 0, 0}, {0, 0, 1}, 1, 10, 0}),
            PlanError::Kind::kArc);
  EXPECT_EQ(kind(canonical::Arc{{9, 0, 0, 0, 0, 0}, machine, {1, 0, 0}, {0, 0, 1}, 1, 10, 0}),
            PlanError::Kind::kArc);
}

TEST(Planner, MovesOfNoLengthAreNoMotion) {
  Job job;
  job.feed(100).by({}).by({10, 0, 0, 0, 0, 0}).by({}).by({1e-9, 0, 0, 0, 0, 0}).by({10, 0, 0, 0, 0, 0});
  const Measured m = measure(m1(), kLimits, job.lines());
  expect_within_limits(m, kLimits, 1e-9);
  EXPECT_EQ(m.counters.moves, 2u);
  EXPECT_NEAR(m.duration_s, 20.0 / 100 + 100.0 / 3000, 1e-6);
}

TEST(Planner, GoesOnFromRestAfterFinish) {
  Planner planner(m1(), kLimits);
  Phase phase;
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(planner.add({1, canonical::Feed{{10.0 * i, 0, 0, 0, 0, 0}, Frame::kMachine, 50, 0}}));
    ASSERT_TRUE(planner.finish());
    double time = 0;
    bool last = false;
    while (planner.next(phase)) {
      if (time == 0) {
        EXPECT_EQ(phase.v0, 0);
      }
      EXPECT_FALSE(last);
      time += phase.duration_s;
      last = phase.last;
    }
    EXPECT_TRUE(last);
    EXPECT_TRUE(planner.idle());
    EXPECT_NEAR(time, 10.0 / 50 + 50.0 / 3000, 1e-9);
  }
  EXPECT_TRUE(planner.finish());
  EXPECT_FALSE(planner.next(phase));
}

TEST(Planner, PhasesComeWhileTheJobIsStillFed) {
  Planner planner(m1(), kLimits);
  planner.reset({}, Frame::kPart);
  Phase phase;
  const Lines lines = random_print(9, 3000);
  std::size_t out = 0, moves = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    ++moves;
    ASSERT_TRUE(planner.add(lines[i]));
    while (planner.next(phase)) {
      ++out;
      // Braking from 200 mm/s takes 7 mm; with batches of pieces and open runs, some hundred lines are
      // enough.
      EXPECT_LT(moves, phase.line + 400);
    }
  }
  EXPECT_GT(out, 3000u);
  EXPECT_EQ(planner.counters().forced_flushes, 0u);
}

TEST(Planner, SmallWindowIsSlowerButStillSafe) {
  const Lines lines = dense_curve(4000, 4, 200, 0.3, 0.5);
  const Measured wide = measure(m1(), kLimits, lines);
  const Measured narrow = measure(m1(), kLimits, lines, 8, false, {.window_pieces = 16});
  expect_within_limits(narrow, kLimits, 0.005);
  EXPECT_GT(narrow.counters.forced_flushes, 0u);
  EXPECT_GT(narrow.duration_s, wide.duration_s);
  EXPECT_EQ(wide.counters.forced_flushes, 0u);
}

}  // namespace
}  // namespace kinebus::probe
