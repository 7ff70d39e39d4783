#include "gateway/jobs/job_plan.hpp"
#include "gateway/description/machines_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>

#include "gateway/description/machine_file.hpp"
#include "gateway/jobs/tests/job_support.hpp"

namespace kinebus {
namespace {

using job_test::kinematics;
using job_test::machine;

struct Planned {
  PlanReport report;
  ProblemList problems;
};

Planned plan(const std::string& job, int lines = 1000, const MachineDescription& on = machine()) {
  StringSource source(job);
  JobPlan p(on, kinematics(), source);
  while (!p.step(lines)) {
  }
  return {p.report(), p.problems()};
}

TEST(JobPlan, SpiralIsStreamedWholeAndInTime) {
  const Planned p = plan(job_test::spiral(40));
  ASSERT_EQ(p.problems.errors(), 0u) << p.problems.all()[0].words;
  EXPECT_GT(p.report.segments, 500u);
  EXPECT_GT(p.report.frames, p.report.segments);
  // The start lead, the run's last tick, nothing else.
  EXPECT_NEAR(p.report.job_time_s, p.report.motion_s, 0.5);
  EXPECT_GT(p.report.bus_load_mean, 0.01);
  EXPECT_LT(p.report.bus_load_peak_1s, 0.6);
}

// 100 m into the job rounding leaves 0.8 nm between a ramp and the piece that it leads to.
TEST(JobPlan, WithLimitedJerkLongAndShortLinesOfAllAnglesComeToAnEnd) {
  auto cartesian = load_machine(machines_folder() / "cartesian.toml");
  ASSERT_TRUE(cartesian);
  cartesian->path.tool_jerk_mm_per_s3 = 50'000;
  const auto axes = make_kinematics(*cartesian);
  ASSERT_TRUE(axes);
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937_64 random(kSeed);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::string job = "G1 X0 Y0 Z30 F3000\nG1 F18000\n";
  for (int i = 0; i < 3000; ++i) {
    const double reach = draw(0, 1) < 0.5 ? 3 : 90;
    // One after the other: arguments have no order.
    const double x = draw(-reach, reach), y = draw(-reach, reach);
    std::array<char, 48> line{};
    std::snprintf(line.data(), line.size(), "G1 X%.3f Y%.3f\n", x, y);
    job += line.data();
  }
  StringSource source(job);
  JobPlan p(*cartesian, **axes, source);
  while (!p.step(1000)) {
  }
  EXPECT_EQ(p.problems().errors(), 0u);
  EXPECT_GT(p.report().motion_s, 1000);
}

TEST(JobPlan, DwellIsPartOfTheJobTime) {
  const Planned p = plan("G1 X10 F3000\nG4 S3\nG1 X0\n");
  EXPECT_NEAR(p.report.job_time_s, p.report.motion_s + 3, 1.0);
}

TEST(JobPlan, ALongDwellCountsAsTheSameFramesAndIsPlannedAtOnce) {
  // 40 s are gone through in two parts, 4 times 10 s frame by frame: equal up to where waits begin in a tick.
  const Planned at_once = plan("G4 S40\n"), in_parts = plan("G4 S10\nG4 S10\nG4 S10\nG4 S10\n");
  EXPECT_EQ(at_once.report.frames, in_parts.report.frames);
  EXPECT_DOUBLE_EQ(at_once.report.job_time_s, in_parts.report.job_time_s);
  EXPECT_NEAR(at_once.report.bus_load_mean, in_parts.report.bus_load_mean, 1e-12);
  EXPECT_NEAR(at_once.report.bus_load_peak_1s, in_parts.report.bus_load_peak_1s, 1e-12);
  // 31 years, and ten times as much: the end of time.
  EXPECT_NEAR(plan("G4 S1000000000\n").report.job_time_s, 1e9, 1);
  std::string ages;
  for (int i = 0; i < 10; ++i) ages += "G4 S1000000000\n";
  EXPECT_LT(plan(ages).report.job_time_s, 1e10);
}

TEST(JobPlan, AnFWithG0LimitsTravelOnAPrinter) {
  const double free = plan("G1 Z5 F6000\nG0 X-40\nG0 X40\n").report.motion_s;
  const double limited = plan("G1 Z5 F6000\nG0 X-40\nG0 X40 F600\n").report.motion_s;
  EXPECT_GT(limited, free + 5) << "80 mm at 10 mm/s";
}

/// Four turns of short lines about a circle of 10 mm.
std::string circle_of_lines(const std::string& before) {
  std::string job = "G21\nG90\nG1 X10 Y0 Z20 F6000\n" + before + "\n";
  for (int i = 1; i <= 1200; ++i) {
    const double t = i * 0.02;
    job += "G1 X" + std::to_string(10 * std::cos(t)) + " Y" + std::to_string(10 * std::sin(t)) + "\n";
  }
  return job;
}

TEST(JobPlan, MachineFileAndG64SayHowShortLinesAreMerged) {
  MachineDescription none = machine(), tight = machine();
  none.tolerances.merge_mm = 0;
  tight.tolerances.merge_mm = 0.0005;
  const Planned by_file = plan(circle_of_lines("")), not_merged = plan(circle_of_lines(""), 1000, none);
  EXPECT_NE(not_merged.report.segments, by_file.report.segments);
  EXPECT_NE(not_merged.report.motion_s, by_file.report.motion_s);
  // A word of the job goes before the file, in both directions.
  EXPECT_EQ(plan(circle_of_lines("G64 P0.005 Q0")).report.motion_s, not_merged.report.motion_s);
  EXPECT_EQ(plan(circle_of_lines("G64 P0.005 Q0.005"), 1000, none).report.motion_s, by_file.report.motion_s);
  EXPECT_EQ(plan(circle_of_lines("G64 Q0.0005")).report.segments,
            plan(circle_of_lines(""), 1000, tight).report.segments);
  EXPECT_NE(plan(circle_of_lines("G64 Q0.0005")).report.segments, by_file.report.segments);
}

TEST(JobPlan, TraversesKeepTheSpeedOfTheMachineFile) {
  const std::string job = "G1 X-50 Y0 Z20 F6000\nG0 X50\nG0 X-50\n";
  MachineDescription slow = machine(), open = machine();
  slow.gcode.traverse_mm_per_s = 50;
  open.gcode.traverse_mm_per_s = 0;
  const double fast_s = plan(job).report.motion_s;
  // Two times 100 mm, and less of it to accelerate.
  const double ramps_s = 2 * (300 - 50) / 3000.0;
  EXPECT_NEAR(plan(job, 1000, slow).report.motion_s - fast_s, 200.0 / 50 - 200.0 / 300 - ramps_s, 0.1);
  EXPECT_EQ(plan(job, 1000, open).report.motion_s, fast_s);
}

TEST(JobPlan, MachineFileSaysWhatPOfADwellCounts) {
  MachineDescription rs274 = machine();
  rs274.gcode.dwell_p_unit = GcodeDescription::DwellUnit::kSeconds;
  const std::string job = "G1 X10 F3000\nG4 P4\nG1 X0\n";
  const double rest_s = plan(job).report.job_time_s;
  EXPECT_NEAR(plan(job, 1000, rs274).report.job_time_s - rest_s, 4, 0.1);
}

TEST(JobPlan, TheDialectOfTheMachineFileOrOfTheHeaderSaysItToo) {
  MachineDescription mill = machine();
  mill.gcode.dialect = gcode::Dialect::kLinuxCnc;
  const std::string job = "G1 X10 F3000\nG4 P4\nG1 X0\n";
  const double rest_s = plan(job).report.job_time_s;
  EXPECT_NEAR(plan(job, 1000, mill).report.job_time_s - rest_s, 4, 0.1);
  EXPECT_NEAR(plan("(Post Processor: linuxcnc_post)\n" + job).report.job_time_s - rest_s, 4, 0.1);
  MachineDescription printer = machine();
  printer.gcode.dialect = gcode::Dialect::kMarlin;
  EXPECT_NEAR(plan("(Post Processor: linuxcnc_post)\n" + job, 1000, printer).report.job_time_s, rest_s, 0.1)
      << "the machine file goes before the header";
}

TEST(JobPlan, FilamentGoesBackIntoAColdNozzleOnlyAsFarAsItWasFedHot) {
  const std::string print = "M83\nM109 S210\nG1 X10 E5 F600\nM104 S0\nG1 E-3\n";
  EXPECT_EQ(plan(print + "G1 E3\n").problems.errors(), 0u);
  EXPECT_EQ(plan(print + "G1 E3.5\n").problems.errors(), 1u);
}

TEST(JobPlan, OutputsThatTheMachineDoesNotHaveAreRefused) {
  for (const char* line : {"M62 P1", "M64 P1", "M68 E1 Q0.5"})
    EXPECT_EQ(plan(std::string(line) + "\nG1 X10 F3000\n").problems.errors(), 1u) << line;
}

TEST(JobPlan, ToolLengthsOfTheMachineFileLiftTheTool) {
  MachineDescription tools = machine();
  tools.gcode.tool_length_mm = {10, 400};
  const std::string rise = "G1 Z20 F6000\n";
  EXPECT_EQ(plan("T1 G43\n" + rise, 1000, tools).problems.errors(), 0u);
  // No reach has 420 mm above the table.
  EXPECT_EQ(plan("G43 H2\n" + rise, 1000, tools).problems.errors(), 1u);
  EXPECT_EQ(plan("T2 G43\n" + rise, 1000, tools).problems.errors(), 1u);
  EXPECT_EQ(plan("G43 H3\n" + rise, 1000, tools).problems.errors(), 1u);
  EXPECT_EQ(plan("T1\n" + rise).problems.errors(), 1u);
}

TEST(JobPlan, CutterCompensationTakesToolDiametersOfTheMachineFile) {
  MachineDescription tools = machine();
  tools.gcode.tool_length_mm = {0, 0};
  tools.gcode.tool_diameter_mm = {0, 6};
  const std::string contour = "G42 G1 F600 X10\nY10\nX0\nY0\nG40 X-10\n";
  EXPECT_EQ(plan("T2\n" + contour, 1000, tools).problems.errors(), 0u);
  EXPECT_EQ(plan("G42 D2\n" + contour.substr(4), 1000, tools).problems.errors(), 0u);
  // No diameter, and one that the way in is too short for.
  EXPECT_GE(plan("T1\n" + contour, 1000, tools).problems.errors(), 1u);
  tools.gcode.tool_diameter_mm = {0, 20};
  EXPECT_GE(plan("T2\n" + contour, 1000, tools).problems.errors(), 1u);
}

TEST(JobPlan, ProblemsAreCollectedToTheEndOfTheJob) {
  const Planned p = plan("G1 X10 F3000\nG1 X5000\nG1 X0\nG1 X200\nG199\n");
  ASSERT_GE(p.problems.errors(), 3u);
  EXPECT_EQ(p.problems.all()[0].line, 2u);
}

TEST(JobPlan, ChunksOfWorkDoNotChangeTheResult) {
  const std::string job = job_test::spiral(15);
  const Planned whole = plan(job), small = plan(job, 3);
  EXPECT_EQ(whole.report.segments, small.report.segments);
  EXPECT_EQ(whole.report.frames, small.report.frames);
  EXPECT_DOUBLE_EQ(whole.report.job_time_s, small.report.job_time_s);
}

TEST(JobPlan, DenseFiveAxisCurveStaysUnderAThirdOfTheBus) {
  std::string job = "G21\nG90\nM83\nM104 S210\nG43.4\nG1 X40 Y0 Z20 A0 C0 F6000\n";
  for (int i = 1; i <= 3000; ++i) {
    const double t = i * 0.2 / 40;
    job += "G1 X" + std::to_string(40 * std::cos(t)) + " Y" + std::to_string(40 * std::sin(t)) + " A" +
           std::to_string(10 * std::sin(t / 2)) + " C" + std::to_string(20 * std::sin(t)) + " E0.006\n";
  }
  const Planned p = plan(job);
  ASSERT_EQ(p.problems.errors(), 0u) << p.problems.all()[0].line << p.problems.all()[0].words;
  EXPECT_LT(p.report.bus_load_mean, 0.35);
}

}  // namespace
}  // namespace kinebus
