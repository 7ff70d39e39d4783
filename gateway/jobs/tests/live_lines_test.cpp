// Lines that come over time give the same motion as the same text as a job.

#include "gateway/jobs/live_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "gateway/jobs/job_pipeline.hpp"
#include "gateway/jobs/tests/job_support.hpp"

namespace kinebus {
namespace {

using job_test::kinematics;
using job_test::machine;
using LineStep = JobPipeline::Step;

/// The motion of a job, at any of its seconds.
struct Motion {
  std::vector<Phase> phases;
  std::vector<double> begins_s;
  double all_s = 0;
  int runs = 0;

  void add(const Phase& phase) {
    begins_s.push_back(all_s);
    phases.push_back(phase);
    all_s += phase.duration_s;
  }
  Pose at(double t) const {
    const auto after = std::upper_bound(begins_s.begin(), begins_s.end(), t);
    const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - begins_s.begin() - 1, 0));
    return phases[i].at(std::min(t - begins_s[i], phases[i].duration_s)).x;
  }
};

bool take(JobPipeline& pipeline, Motion& motion) {
  int budget = 1000;
  for (;;) {
    const LineStep step = pipeline.next(budget);
    if (step == LineStep::kPhase) motion.add(pipeline.phase());
    if (step == LineStep::kRunEnd) ++motion.runs;
    EXPECT_NE(step, LineStep::kProblem) << pipeline.problem().words;
    if (step == LineStep::kProblem || step == LineStep::kEnd) return false;
    if (step == LineStep::kStarved || step == LineStep::kMore) return true;
  }
}

Motion motion_of_job(const std::string& text) {
  JobPipeline pipeline(machine(), kinematics());
  StringSource source(text);
  pipeline.start_job(source, kinematics().bed_reference());
  Motion motion;
  while (take(pipeline, motion)) continue;
  return motion;
}

/// `starve`: chance that the next line is late, so that what is there must settle.
Motion motion_of_lines(const std::string& text, std::uint64_t seed, double starve) {
  std::mt19937_64 random(seed);
  LiveLines lines(machine(), kinematics());
  JobPipeline pipeline(machine(), kinematics());
  gcode::CommandBuffer commands;
  lines.begin(kinematics().bed_reference(), {}, commands);
  pipeline.start_live(kinematics().bed_reference());
  for (const auto& command : commands) pipeline.add(command);
  Motion motion;
  std::istringstream in(text);
  std::string line;
  for (std::uint32_t number = 1; std::getline(in, line); ++number) {
    commands.clear();
    const auto taken = lines.take(line, number, commands);
    EXPECT_TRUE(taken) << line << ": " << taken.error().words;
    for (const auto& command : commands) pipeline.add(command);
    if (random() % 3 == 0) {
      EXPECT_TRUE(take(pipeline, motion));
    }
    if (std::uniform_real_distribution<double>(0, 1)(random) >= starve) continue;
    EXPECT_TRUE(take(pipeline, motion));
    pipeline.settle_live();
    EXPECT_TRUE(take(pipeline, motion));
    EXPECT_TRUE(pipeline.live_idle());
  }
  pipeline.end_live();
  while (take(pipeline, motion)) continue;
  return motion;
}

std::string job() {
  std::string text =
      job_test::spiral(60) + "G1 X0 Y0\nG2 X10 Y10 I5 J5 F3000\nG4 P20\nG0 X0 Y0\nM106 S200\nG28\n";
  for (int i = 0; i < 300; ++i)
    text += "G1 X" + std::to_string(30 * std::cos(i * 0.02)) + " Y" +
            std::to_string(30 * std::sin(i * 0.02)) + " E0.01\n";
  return text;
}

TEST(LiveLines, MotionIsThatOfTheSameTextAsAJobWhateverTheLinesTiming) {
  const Motion whole = motion_of_job(job());
  ASSERT_GT(whole.all_s, 20);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Motion live = motion_of_lines(job(), seed, 0);
    ASSERT_NEAR(live.all_s, whole.all_s, 1e-9) << "seed " << seed;
    EXPECT_EQ(live.runs, whole.runs);
    for (double t = 0; t < whole.all_s; t += 0.0037) {
      const Pose a = live.at(t), b = whole.at(t);
      for (std::size_t axis = 0; axis < kPoseAxes; ++axis)
        ASSERT_NEAR(a[axis], b[axis], 1e-9) << "seed " << seed << ", " << t << " s, axis " << axis;
    }
  }
}

TEST(LiveLines, LateLinesEndInStopsOnThePathAndMotionGoesOnFromThere) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Motion live = motion_of_lines(job(), seed, 0.05);
    EXPECT_GT(live.runs, 10);
    for (std::size_t i = 1; i < live.phases.size(); ++i) {
      const Phase& before = live.phases[i - 1];
      const Phase& after = live.phases[i];
      const Pose a = before.at(before.duration_s).x, b = after.at(0).x;
      const auto place = ::testing::Message() << "seed " << seed << ", line " << after.line;
      for (std::size_t axis = 0; axis < kPoseAxes && before.piece.frame == after.piece.frame; ++axis) {
        ASSERT_NEAR(a[axis], b[axis], 1e-6) << place;
      }
      if (!before.last) continue;
      ASSERT_NEAR(after.v0, 0, 1e-6) << place;
      ASSERT_NEAR(before.speed(before.duration_s), 0, 1e-6) << place;
    }
    const Motion whole = motion_of_job(job());
    const Pose a = live.at(live.all_s), b = whole.at(whole.all_s);
    for (std::size_t axis = 0; axis < kPoseAxes; ++axis) EXPECT_NEAR(a[axis], b[axis], 1e-9);
  }
}

class Lines : public ::testing::Test {
 protected:
  Lines() {
    lines.begin(kinematics().bed_reference(), {}, out);
    out.clear();
  }
  std::string refused(const std::string& line) {
    const auto taken = lines.take(line, ++number, out);
    return taken ? std::string() : std::string(taken.error().words);
  }
  LiveLines lines{machine(), kinematics()};
  gcode::CommandBuffer out;
  std::uint32_t number = 0;
};

TEST_F(Lines, LineOutOfReachIsRefusedAndTheNextGoesOnFromWhereTheToolIs) {
  EXPECT_EQ(refused("G1 X10 F3000"), "");
  out.clear();
  EXPECT_NE(refused("G1 X900"), "");
  EXPECT_TRUE(out.empty());
  EXPECT_EQ(refused("G91"), "");
  EXPECT_EQ(refused("G1 Y5"), "");
  const auto& feed = std::get<canonical::Feed>(out.back().command);
  EXPECT_NEAR(feed.target[kX], 10, 1e-12);
  EXPECT_NEAR(feed.target[kY], 5, 1e-12);
}

TEST_F(Lines, PathBetweenReachableEndsIsCheckedToo) {
  EXPECT_EQ(refused("G1 Z1 F3000"), "");
  EXPECT_NE(refused("G2 X0 Y0 I400 J0"), "");
  EXPECT_NE(refused("G18 G2 X40 Z1 R21"), "") << "an arc below the bed";
}

TEST_F(Lines, HeatersAreAskedOnlyForWhatTheyMayGive) {
  EXPECT_NE(refused("M104 S900"), "");
  EXPECT_NE(refused("M140 S900"), "");
  EXPECT_EQ(refused("M104 S50"), "");
  EXPECT_NE(refused("G1 E5 F300"), "") << "filament into a cold hotend";
  EXPECT_EQ(refused("M104 S210"), "");
  EXPECT_EQ(refused("G1 E5 F300"), "");
}

TEST_F(Lines, BeforeTheMachineMayMoveOnlyModesAreTaken) {
  LiveLines fresh(machine(), kinematics());
  EXPECT_TRUE(fresh.take("G91", 1, out));
  EXPECT_TRUE(fresh.take("M204 P500", 2, out));
  EXPECT_FALSE(fresh.take("G1 X1 F100", 3, out));
  EXPECT_FALSE(fresh.take("G28", 4, out));
  out.clear();
  fresh.begin(kinematics().bed_reference(), {}, out);
  ASSERT_FALSE(out.empty());
  EXPECT_EQ(std::get<canonical::Limits>(out.back().command).print_accel_mm_per_s2, 500);
  out.clear();
  EXPECT_TRUE(fresh.take("G1 X1 F100", 5, out));
  EXPECT_NEAR(std::get<canonical::Feed>(out.back().command).target[kX], 1, 1e-12);
}

TEST_F(Lines, ProgramKeepsItsEWhenTheMachineWasMovedInBetween) {
  EXPECT_EQ(refused("M82"), "");
  EXPECT_EQ(refused("G92 E100"), "");
  Pose elsewhere = kinematics().bed_reference();
  elsewhere[kE] = 7;
  elsewhere[kX] = 12;
  lines.begin(elsewhere, {}, out);
  out.clear();
  EXPECT_EQ(refused("G1 E101 F300"), "");
  const auto& feed = std::get<canonical::Feed>(out.back().command);
  EXPECT_NEAR(feed.target[kE], 8, 1e-12);
  EXPECT_NEAR(feed.target[kX], 12, 1e-9);
}

TEST_F(Lines, CutterCompensationIsRefusedForItLooksAhead) {
  EXPECT_EQ(refused("G1 X10 F600"), "");
  EXPECT_EQ(refused("G41.1 D2"),
            "cutter compensation belongs to a job: it looks ahead, which single lines cannot");
  EXPECT_EQ(refused("G40 G1 X20"), "");
  EXPECT_NEAR(std::get<canonical::Feed>(out.back().command).target[kX], 20, 1e-9);
}

TEST_F(Lines, AnObjectIsLeftOutWhileItsLinesCome) {
  for (const char* line : {"M83", "M486 S1", "G1 X10 E1 F600", "M486 P1", "G1 X20 E1"})
    EXPECT_EQ(refused(line), "");
  ASSERT_FALSE(out.empty());
  EXPECT_NEAR(std::get<canonical::Feed>(out.back().command).target[kX], 10, 1e-9);
  // Meanwhile a host's pause has brought the machine to rest elsewhere.
  Pose elsewhere = kinematics().bed_reference();
  elsewhere[kX] = 15;
  elsewhere[kE] = 40;
  lines.begin(elsewhere, {}, out);
  out.clear();
  for (const char* line : {"M486 S2", "G0 X30 Y1"}) EXPECT_EQ(refused(line), "");
  ASSERT_FALSE(out.empty());
  const Pose& there = std::get<canonical::Traverse>(out.back().command).target;
  EXPECT_NEAR(there[kX], 30, 1e-9);
  EXPECT_NEAR(there[kE], 40, 1e-9);
  EXPECT_EQ(refused("G1 X31 E1"), "");
  EXPECT_NEAR(std::get<canonical::Feed>(out.back().command).target[kE], 41, 1e-9);
}

TEST_F(Lines, FilamentGoesBackIntoAColdNozzleOnlyAsFarAsItWasFedHot) {
  for (const char* line : {"M83", "M104 S210", "G1 E5 F300", "M104 S0", "G1 E-3", "G1 E3"})
    EXPECT_EQ(refused(line), "");
  EXPECT_NE(refused("G1 E0.5"), "");
}

}  // namespace
}  // namespace kinebus
