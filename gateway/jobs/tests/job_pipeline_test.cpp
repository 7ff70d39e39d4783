#include "gateway/jobs/job_pipeline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/jobs/tests/job_support.hpp"

namespace kinebus {
namespace {

using PipelineStep = JobPipeline::Step;
using job_test::kinematics;
using job_test::machine;

/// The steps of a job as letters: p phases (a run of them is one letter), e event, r run's end, b barrier, m
/// melt, x problem.
struct Trace {
  std::string steps;
  std::vector<double> event_s;
  std::vector<Problem> problems;
  double motion_s = 0;
  Pose end{};
  Frame frame{};
  std::uint32_t lines = 0;
};

Trace trace(const std::string& job, Pose start = kinematics().bed_reference(), int budget = 1'000'000) {
  StringSource source(job);
  JobPipeline pipeline(machine(), kinematics());
  pipeline.start_job(source, start);
  Trace t;
  for (int guard = 0; guard < 2'000'000; ++guard) {
    int left = budget;
    switch (pipeline.next(left)) {
      case PipelineStep::kPhase:
        if (t.steps.empty() || t.steps.back() != 'p') t.steps += 'p';
        t.motion_s += pipeline.phase().duration_s;
        t.end = pipeline.phase().at(pipeline.phase().duration_s).x;
        t.frame = pipeline.phase().piece.frame;
        break;
      case PipelineStep::kEvent:
        t.steps += 'e';
        t.event_s.push_back(pipeline.event_s());
        break;
      case PipelineStep::kRunEnd:
        t.steps += 'r';
        break;
      case PipelineStep::kBarrier:
        t.steps += 'b';
        break;
      case PipelineStep::kMelt:
        t.steps += 'm';
        break;
      case PipelineStep::kProbed:
        t.steps += 'q';
        pipeline.probed(pipeline.assumed_probe());
        break;
      case PipelineStep::kProblem:
        t.steps += 'x';
        t.problems.push_back(pipeline.problem());
        break;
      case PipelineStep::kMore:
      case PipelineStep::kStarved:
        break;
      case PipelineStep::kEnd:
        t.lines = pipeline.lines();
        return t;
    }
  }
  ADD_FAILURE() << "the job does not end";
  return t;
}

TEST(JobPipeline, EmptyJobEndsAtOnce) {
  EXPECT_EQ(trace("").steps, "");
}

TEST(JobPipeline, AProbesMoveIsARunOfItsOwnAndTheTextGoesOnFromItsResult) {
  MachineDescription probing = machine();
  probing.probe.present = true;
  probing.probe.place.where = DevicePlace::Where::kNode;
  StringSource source("G0 X5\nG38.2 Z-5 F300\nG1 Z[#5063 + 7] F600\n");
  JobPipeline pipeline(probing, kinematics());
  pipeline.start_job(source, kinematics().bed_reference());
  std::string steps;
  Pose end{};
  for (int budget = 1000;;) {
    const PipelineStep step = pipeline.next(budget);
    if (step == PipelineStep::kEnd) break;
    ASSERT_NE(step, PipelineStep::kProblem) << pipeline.problem().words;
    if (step == PipelineStep::kPhase) {
      end = pipeline.phase().at(pipeline.phase().duration_s).x;
      if (steps.empty() || steps.back() != 'p') steps += 'p';
    } else if (step == PipelineStep::kProbed) {
      // Until it is told how the move ended nothing is read.
      EXPECT_EQ(pipeline.next(budget), PipelineStep::kProbed);
      steps += 'q';
      const gcode::ProbeResult assumed = pipeline.assumed_probe();
      EXPECT_NEAR(assumed.at[kZ], 0, 1e-9) << "the table's surface is on the way";
      gcode::ProbeResult result = assumed;
      result.at[kZ] = 2;
      result.stand[kZ] = 1.9;
      pipeline.probed(result);
    } else {
      steps += step == PipelineStep::kBarrier ? 'b' : 'r';
    }
  }
  EXPECT_EQ(steps, "prbprqpr");
  EXPECT_NEAR(end[kZ], 9, 1e-9);
}

TEST(JobPipeline, EventsOfALoopFallDueInEachTurn) {
  const Trace t = trace("o1 repeat [3]\nG91 G1 X5 F3000\nM117 turn\no1 endrepeat\nG90 G1 X-10\n");
  EXPECT_EQ(t.steps, "pepepepr");
  ASSERT_EQ(t.event_s.size(), 3U);
  EXPECT_GT(t.event_s[0], 0.05);
  EXPECT_GT(t.event_s[1], t.event_s[0] + 0.05);
  EXPECT_GT(t.event_s[2], t.event_s[1] + 0.05);
  EXPECT_NEAR(t.end[kX], -10, 1e-6);
}

TEST(JobPipeline, ProblemsInLoopsNameTheLineOfTheText) {
  const Trace t = trace("G1 X1 F3000\no1 repeat [2]\nG1 X2\nG1 X1\nM20\no1 endrepeat\nG1 X5\nM20\n");
  ASSERT_EQ(t.problems.size(), 3U);
  EXPECT_EQ(t.problems[0].line, 5U);
  EXPECT_EQ(t.problems[1].line, 5U);
  EXPECT_EQ(t.problems[2].line, 8U);
  EXPECT_EQ(t.lines, 8U);
}

TEST(JobPipeline, AJobPausesItself) {
  EXPECT_EQ(trace("G1 X1 F3000\nM25\nG1 X2\n").steps, "prbpr");
}

TEST(JobPipeline, MovesMakeOneRunThatEndsAtTheLastTarget) {
  const Trace t = trace("G1 X10 Y0 Z20 F3000\nG1 X10 Y10\n");
  EXPECT_EQ(t.steps, "pr");
  EXPECT_NEAR(t.end[kX], 10, 1e-6);
  EXPECT_NEAR(t.end[kY], 10, 1e-6);
  EXPECT_GT(t.motion_s, 0.4);
}

TEST(JobPipeline, DwellSplitsMotionIntoTwoRuns) {
  EXPECT_EQ(trace("G1 X10 F3000\nG4 P500\nG1 X0\n").steps, "prbpr");
}

TEST(JobPipeline, TemperatureWithoutWaitFallsDueInTheMidstOfARun) {
  const Trace t = trace("G1 X10 F3000\nM104 S200\nG1 X20\nG1 X30\n");
  EXPECT_EQ(t.steps, "pepr");
  ASSERT_EQ(t.event_s.size(), 1u);
  EXPECT_NEAR(t.event_s[0], 10 / 50.0, 0.05);
}

TEST(JobPipeline, WaitForTemperatureIsABarrier) {
  EXPECT_EQ(trace("G1 X10 F3000\nM109 S200\nG1 X20\n").steps, "prbpr");
}

TEST(JobPipeline, EventsAfterTheLastMoveComeBeforeTheRunsEnd) {
  EXPECT_EQ(trace("G1 X10 F3000\nM107\nM104 S0\n").steps, "peer");
}

TEST(JobPipeline, EventsBeforeAnyMoveComeFirst) {
  const Trace t = trace("M106 S255\nG1 X10 F3000\n");
  EXPECT_EQ(t.steps, "epr");
  EXPECT_EQ(t.event_s[0], 0);
}

TEST(JobPipeline, HomingInAJobGoesToTheBedReferenceAndRests) {
  const Trace t = trace("G1 X10 F3000\nG28\n");
  EXPECT_EQ(t.steps, "prprb");
  const Pose reference = kinematics().bed_reference();
  for (const int axis : {kX, kY, kZ}) EXPECT_NEAR(t.end[axis], reference[axis], 1e-6) << axis;
}

TEST(JobPipeline, AProblemNamesItsLineAndTheRestIsStillRead) {
  const Trace t = trace("G1 X10 F3000\nG1 X10 Q\nG1 X20\nG7777\nG1 X0\n");
  ASSERT_EQ(t.problems.size(), 2u);
  EXPECT_EQ(t.problems[0].line, 2u);
  EXPECT_EQ(t.problems[1].line, 4u);
  EXPECT_FALSE(t.problems[0].words.empty());
  EXPECT_EQ(t.lines, 5u);
}

TEST(JobPipeline, OutOfReachIsAProblemOfItsLine) {
  const Trace t = trace("G1 X10 F3000\nG1 X5000\nG1 X0\nG1 Y5000\n");
  ASSERT_EQ(t.problems.size(), 2u);
  EXPECT_EQ(t.problems[0].line, 2u);
  EXPECT_EQ(t.problems[1].line, 4u);
}

TEST(JobPipeline, StoredJobCommandsAreRefusedInAJob) {
  const Trace t = trace("M23 other.gcode\nG1 X1 F3000\n");
  ASSERT_FALSE(t.problems.empty());
  EXPECT_EQ(t.problems[0].line, 1u);
}

TEST(JobPipeline, BudgetOfOneLineGivesTheSameJob) {
  const std::string job = job_test::spiral(20);
  const Trace all = trace(job);
  const Trace piecewise = trace(job, kinematics().bed_reference(), 1);
  EXPECT_EQ(all.steps, piecewise.steps);
  EXPECT_DOUBLE_EQ(all.motion_s, piecewise.motion_s);
}

TEST(JobPipeline, ReadInPiecesOfOneByteGivesTheSameJob) {
  struct Drops : StringSource {
    using StringSource::StringSource;
    std::size_t read(std::span<char> buffer) override { return StringSource::read(buffer.first(1)); }
  };
  const std::string job = job_test::spiral(5);
  const double whole = trace(job).motion_s;
  Drops source(job);
  JobPipeline pipeline(machine(), kinematics());
  pipeline.start_job(source, kinematics().bed_reference());
  double motion_s = 0;
  int budget = 1 << 30;
  for (PipelineStep step = pipeline.next(budget); step != PipelineStep::kEnd; step = pipeline.next(budget))
    if (step == PipelineStep::kPhase) motion_s += pipeline.phase().duration_s;
  EXPECT_DOUBLE_EQ(motion_s, whole);
}

TEST(JobPipeline, FeedScaleMakesAJobFaster) {
  StringSource source("G1 X50 F600\n");
  JobPipeline pipeline(machine(), kinematics());
  pipeline.start_job(source, kinematics().bed_reference());
  pipeline.set_feed_scale(2);
  double motion_s = 0;
  int budget = 1000;
  for (PipelineStep step = pipeline.next(budget); step != PipelineStep::kEnd; step = pipeline.next(budget))
    if (step == PipelineStep::kPhase) motion_s += pipeline.phase().duration_s;
  EXPECT_NEAR(motion_s, 50 / 20.0, 0.1);
}

/// Motion of all runs, s, and how many there are.
std::pair<double, int> motion_of(const MachineDescription& shaped, const std::string& job, int lines) {
  StringSource source(job);
  JobPipeline pipeline(shaped, kinematics());
  pipeline.start_job(source, kinematics().bed_reference());
  double motion_s = 0;
  int runs = 0, budget = lines;
  for (PipelineStep step = pipeline.next(budget); step != PipelineStep::kEnd; step = pipeline.next(budget)) {
    if (step == PipelineStep::kMore) budget = lines;
    if (step == PipelineStep::kRunEnd) ++runs;
    if (step != PipelineStep::kPhase) continue;
    EXPECT_TRUE(pipeline.phase().timed);
    motion_s += pipeline.phase().duration_s;
  }
  return {motion_s, runs};
}

TEST(JobPipeline, ShapingMakesEachRunLongerByTheShaper) {
  const std::string job = "G1 X50 F3000\nM117 half\nG1 X20 Y20\nG4 P100\nG1 X0\n";
  MachineDescription shaped = machine();
  shaped.vibration.every = {ShaperKind::kZvd, 40, 0};
  const double plain_s = trace(job).motion_s;
  for (const int lines : {1, 1000}) {
    const auto [motion_s, runs] = motion_of(shaped, job, lines);
    EXPECT_EQ(runs, 2);
    // The joints' reserve makes a little of it slower.
    EXPECT_NEAR(motion_s, plain_s + 2.0 / 40, 0.02 * plain_s);
    EXPECT_GE(motion_s, plain_s + 2.0 / 40 - 1e-6);
  }
}

TEST(JobPipeline, AJobShapesItsMotionFromALineOn) {
  const std::string move = "G1 X50 F3000\nG1 X20 Y20\n", half = "M593 P\"zvd\" F40 S0\n";
  const double plain_s = trace(move).motion_s;
  StringSource source(move + half + "G1 X50 Y0\nG1 X20 Y20\nM593 F0\nG1 X50\n");
  JobPipeline pipeline(machine(), kinematics());
  pipeline.start_job(source, kinematics().bed_reference());
  std::vector<double> runs_s{0};
  std::vector<bool> timed;
  int budget = 1'000'000;
  for (PipelineStep step = pipeline.next(budget); step != PipelineStep::kEnd; step = pipeline.next(budget)) {
    ASSERT_NE(step, PipelineStep::kProblem) << pipeline.problem().words.english();
    if (step == PipelineStep::kRunEnd) runs_s.push_back(0);
    if (step != PipelineStep::kPhase) continue;
    if (runs_s.back() == 0) timed.push_back(pipeline.phase().timed);
    runs_s.back() += pipeline.phase().duration_s;
  }
  ASSERT_EQ(timed, (std::vector<bool>{false, true, false}));
  EXPECT_NEAR(runs_s[0], plain_s, 1e-9);
  // The same as on a machine that says so in its file.
  MachineDescription shaped = machine();
  shaped.vibration.every = {ShaperKind::kZvd, 40, 0};
  const std::string before = "G1 X50 F3000\nG1 X20 Y20\nG4 P1\n";
  EXPECT_NEAR(motion_of(shaped, before + "G1 X50 Y0\nG1 X20 Y20\n", 1000).first -
                  motion_of(shaped, before, 1000).first,
              runs_s[1], 1e-9);
  // The next job knows nothing of it.
  StringSource again(move);
  pipeline.start_job(again, kinematics().bed_reference());
  double next_s = 0;
  for (PipelineStep step = pipeline.next(budget); step != PipelineStep::kEnd; step = pipeline.next(budget))
    if (step == PipelineStep::kPhase) next_s += pipeline.phase().duration_s;
  EXPECT_NEAR(next_s, plain_s, 1e-9);
}

TEST(JobPipeline, AShaperThatTheMachineCannotTakeIsRefusedWithItsLine) {
  for (const char* line : {"M593 X F40\n", "SET_INPUT_SHAPER SHAPER_TYPE=zv\n",
                           "SET_INPUT_SHAPER SHAPER_FREQ_X=40 SHAPER_FREQ_Y=50\n"}) {
    StringSource source(std::string("G1 X50 F3000\n") + line + "G1 X0\n");
    JobPipeline pipeline(machine(), kinematics());
    pipeline.start_job(source, kinematics().bed_reference());
    int budget = 1000, problems = 0;
    for (PipelineStep step = pipeline.next(budget); step != PipelineStep::kEnd;
         step = pipeline.next(budget)) {
      if (step != PipelineStep::kProblem) continue;
      ++problems;
      EXPECT_EQ(pipeline.problem().line, 2U) << line;
    }
    EXPECT_EQ(problems, 1) << line;
  }
}

TEST(JobPipeline, AStatedDeviationLowersTheAcceleration) {
  const std::string job = "G1 X50 F12000\nG1 X0\n";
  MachineDescription shaped = machine();
  shaped.vibration.every = {ShaperKind::kEi, 50, 0};
  const double free_s = motion_of(shaped, job, 1000).first;
  shaped.vibration.deviation_mm = 0.020;
  EXPECT_NEAR(limits_before_shaping(shaped, shaped.vibration).tool_accel_mm_per_s2, 762, 1);
  EXPECT_GT(motion_of(shaped, job, 1000).first, free_s + 0.1);
  EXPECT_EQ(limits_before_shaping(machine(), {}).tool_accel_mm_per_s2, 3000);
}

TEST(JobPipeline, LongShapersLeaveTheJointsAReserve) {
  MachineDescription shaped = machine();
  shaped.vibration.every = {ShaperKind::kThreeHump, 20, 0};
  EXPECT_LT(limits_before_shaping(shaped, shaped.vibration).joint_accel_per_s2[0],
            0.9 * motion_limits(shaped).joint_accel_per_s2[0]);
  EXPECT_EQ(limits_before_shaping(shaped, shaped.vibration).joint_accel_per_s2[5],
            motion_limits(shaped).joint_accel_per_s2[5]);
}

}  // namespace
}  // namespace kinebus
