// Pressure advance of whole jobs: from which line on it acts, and what it asks of the extruder.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "gateway/jobs/job_pipeline.hpp"
#include "gateway/jobs/tests/job_support.hpp"

namespace kinebus {
namespace {

using Step = JobPipeline::Step;
using job_test::kinematics;
using job_test::machine;

/// Filament ahead of what the tool's place asks for, on a straight line along X that takes 0.05 mm a mm: most
/// of it in the lines up to `line`, and behind it.
struct Ahead {
  double before_mm = 0, behind_mm = 0, least_mm = 0, end_mm = 0;
  int runs = 0;
};

Ahead ahead_of(JobPipeline& pipeline, std::uint32_t line) {
  Ahead ahead;
  int budget = 1'000'000;
  for (Step step = pipeline.next(budget); step != Step::kEnd; step = pipeline.next(budget)) {
    EXPECT_NE(step, Step::kProblem);
    if (step == Step::kRunEnd) ++ahead.runs;
    if (step != Step::kPhase) continue;
    const Phase& phase = pipeline.phase();
    for (const double t : {0.0, 0.5 * phase.duration_s, phase.duration_s}) {
      const Pose pose = phase.at(t).x;
      const double by_mm = pose[kE] - 0.05 * pose[kX];
      double& most = phase.line <= line ? ahead.before_mm : ahead.behind_mm;
      most = std::max(most, by_mm);
      ahead.least_mm = std::min(ahead.least_mm, by_mm);
      ahead.end_mm = by_mm;
    }
  }
  return ahead;
}

constexpr const char* kStraight = "G1 Z20 F3000\nG92 X0 Y0 E0\nG1 X20 E1 F3000\nG1 X40 E2\n";

Ahead ahead_in(const MachineDescription& of, const std::string& job, std::uint32_t line) {
  StringSource source(job);
  JobPipeline pipeline(of, kinematics());
  pipeline.start_job(source, kinematics().bed_reference());
  return ahead_of(pipeline, line);
}

TEST(PipelineAdvance, ActsFromItsLineOn) {
  const Ahead plain = ahead_in(machine(), kStraight + std::string("M900 K0\nG1 X60 E3\nG1 X80 E4\n"), 4);
  EXPECT_EQ(plain.runs, 1);
  EXPECT_LE(plain.behind_mm, 1e-6);
  const Ahead one = ahead_in(machine(), kStraight + std::string("M900 K0.05\nG1 X60 E3\nG1 X80 E4\n"), 4);
  EXPECT_EQ(one.runs, 2);
  EXPECT_LE(one.before_mm, 1e-6);
  EXPECT_NEAR(one.behind_mm, 0.05 * 2.5, 1e-6);
  EXPECT_GE(one.least_mm, -1e-6);
  EXPECT_NEAR(one.end_mm, 0, 1e-9);
  // Where it acts already the path rests for an instant, and the run goes on.
  MachineDescription advanced = machine();
  advanced.pressure_advance.advance_s = 0.02;
  const Ahead two =
      ahead_in(advanced, kStraight + std::string("M900 K0.02\nM900 K0.06\nG1 X60 E3\nG1 X80 E4\n"), 4);
  EXPECT_EQ(two.runs, 1);
  EXPECT_NEAR(two.before_mm, 0.02 * 2.5, 1e-6);
  EXPECT_NEAR(two.behind_mm, 0.06 * 2.5, 1e-6);
  EXPECT_NEAR(two.end_mm, 0, 1e-9);
  const Ahead off = ahead_in(advanced, kStraight + std::string("M572 D0 S0\nG1 X60 E3\nG1 X80 E4\n"), 4);
  EXPECT_EQ(off.runs, 1);
  EXPECT_NEAR(off.before_mm, 0.02 * 2.5, 1e-6);
  EXPECT_LE(off.behind_mm, 0.01);
  const Ahead smooth = ahead_in(
      advanced, kStraight + std::string("SET_PRESSURE_ADVANCE SMOOTH_TIME=0.03\nG1 X60 E3\nG1 X80 E4\n"), 4);
  EXPECT_EQ(smooth.runs, 2);
  EXPECT_NEAR(smooth.behind_mm, 0.02 * 2.5, 1e-6);
}

TEST(PipelineAdvance, ActsInLinesThatComeOneByOne) {
  JobPipeline pipeline(machine(), kinematics());
  Pose place = kinematics().bed_reference();
  pipeline.start_live(place);
  const auto feed = [&](double by_mm) {
    place[kX] += by_mm;
    place[kE] += 0.05 * by_mm;
    pipeline.add({0, canonical::Feed{.target = place, .frame = Frame::kMachine, .feed_per_s = 50}});
  };
  const double shift = place[kE] - 0.05 * place[kX];
  feed(20);
  pipeline.add({0, canonical::PressureAdvance{0.05, -1}});
  feed(40);
  pipeline.add({0, canonical::End{}});
  const Ahead ahead = ahead_of(pipeline, 0);
  EXPECT_EQ(ahead.runs, 2);
  EXPECT_NEAR(ahead.before_mm - shift, 0.05 * 2.5, 1e-6);
  EXPECT_NEAR(ahead.end_mm, shift, 1e-9);
}

TEST(PipelineAdvance, KeepsTheExtruderWithinItsLimits) {
  MachineDescription advanced = machine();
  advanced.pressure_advance = {.advance_s = 0.1, .melt_s = 0.01, .smooth_s = 0.005};
  // 0.5 mm of filament a mm, which by itself takes 1500 of the 3000 mm/s^2.
  std::string job = "G1 Z20 F3000\nG92 E0\nM83\nG1 E-3 F3600\n";
  for (int i = 0; i < 12; ++i)
    job += i % 2 == 0 ? "G1 E3 F3600\nG1 X8 E4 F6000\nG1 Y8 E4\nG1 E-3 F3600\nG1 X0 F12000\n"
                      : "G1 X3 Y0 E0.9\nG1 X1 Y1 E0.9\n";
  StringSource source(job);
  JobPipeline pipeline(advanced, kinematics());
  pipeline.start_job(source, kinematics().bed_reference());
  int budget = 1'000'000;
  double speed = 0, accel = 0;
  for (Step step = pipeline.next(budget); step != Step::kEnd; step = pipeline.next(budget)) {
    ASSERT_NE(step, Step::kProblem) << pipeline.problem().words.english();
    if (step != Step::kPhase) continue;
    const Phase& phase = pipeline.phase();
    for (const double t : {0.0, 0.5 * phase.duration_s, phase.duration_s}) {
      speed = std::max(speed, std::abs(phase.at(t).x1[kE]));
      accel = std::max(accel, std::abs(phase.at(t).x2[kE]));
    }
  }
  EXPECT_LE(speed, 60);
  EXPECT_GT(speed, 30);
  EXPECT_LE(accel, 3000);
  EXPECT_GT(accel, 1500);
}

}  // namespace
}  // namespace kinebus
