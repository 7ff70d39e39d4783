#include "gateway/jobs/preflight.hpp"
#include "gateway/description/machines_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "gateway/bodies/tests/legs_below.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/jobs/tests/job_support.hpp"

namespace kinebus {
namespace {

using job_test::kinematics;
using job_test::machine;

struct Checked {
  JobReport report;
  ProblemList problems;
};

Checked check(const std::string& job, JobCheck::Options options = {}) {
  StringSource source(job);
  Preflight preflight(machine(), kinematics(), source, kinematics().bed_reference(), options);
  while (!preflight.step(1000)) {
  }
  return {preflight.report(), preflight.problems()};
}

TEST(Preflight, GoodJobHasNoErrors) {
  const Checked c = check(job_test::spiral(30));
  EXPECT_EQ(c.problems.errors(), 0u) << c.problems.all()[0].words;
  EXPECT_EQ(c.report.lines, 125u);
  EXPECT_GT(c.report.motion_s, 10);
}

TEST(Preflight, LeavingTheWorkspaceIsReportedOncePerWayOutWithItsLine) {
  const Checked c = check("G1 X0 F6000\nG1 X170\nG1 X175\nG1 X0\nG1 X-170\nG1 X0\n");
  ASSERT_EQ(c.problems.errors(), 2u);
  EXPECT_EQ(c.problems.all()[0].line, 2u);
  EXPECT_EQ(c.problems.all()[1].line, 5u);
}

TEST(Preflight, HowFarALineLeadsOutIsSaidAndNotWhereItLeaves) {
  const Checked c = check("G1 X0 F6000\nG1 X200\nG1 X0\nG1 X-170\n");
  ASSERT_EQ(c.problems.errors(), 2u);
  const auto outside_mm = [&](std::size_t i) {
    const std::string said = c.problems.all()[i].words.english();
    return said.starts_with("X is ") ? std::stod(said.substr(5)) : 0;
  };
  // Poses are looked at every millimetre.
  EXPECT_NEAR(outside_mm(0), 49.5, 0.51);
  EXPECT_NEAR(outside_mm(1), 19.5, 0.51);
}

// With the hot end on a node a run refuses what it would feed cold: the check says as much as it knows.
TEST(Preflight, AJobThatLeavesTheHotEndAsItFindsItIsJudgedByThat) {
  MachineDescription on_node = machine();
  for (HeaterDescription& heater : on_node.heaters)
    heater.place = {.where = DevicePlace::Where::kNode, .node_id = 20, .channel = 1};
  const auto found = [&on_node](const std::string& job, std::optional<double> hotend_celsius) {
    StringSource source(job);
    JobCheck::Options options;
    options.hotend_celsius[0] = hotend_celsius;
    Preflight preflight(on_node, kinematics(), source, kinematics().bed_reference(), options);
    while (!preflight.step(1000)) {
    }
    const std::string by_found = preflight.feeds_by_found_heat() ? "found: " : "own: ";
    const auto& all = preflight.problems().all();
    if (all.empty()) return by_found;
    return by_found + (preflight.problems().errors() > 0 ? "error " : "warning ") +
           std::to_string(all[0].line) + " " + all[0].words.english();
  };
  const std::string job = "G1 X5 F600\nG1 X10 E3\n";
  EXPECT_EQ(
      found(job, std::nullopt),
      "found: warning 2 filament is fed before the job has set a hotend temperature (M104): it runs only "
      "while the hotend is set to at least 170 C");
  EXPECT_EQ(found(job, 0), "found: error 2 filament is fed with the hotend at 0 C; at least 170 C is needed");
  EXPECT_EQ(found(job, 200), "found: ");
  EXPECT_EQ(found("M104 S200\n" + job, std::nullopt), "own: ");
  EXPECT_EQ(found("M104 S150\n" + job, 200),
            "own: error 3 filament is fed with the hotend at 150 C; at least 170 C is needed");
}

TEST(Preflight, BorderIsFoundWithinAMillimetre) {
  EXPECT_EQ(check("G1 X149.9 F6000\n").problems.errors(), 0u);
  EXPECT_EQ(check("G1 X150.1 F6000\n").problems.errors(), 1u);
}

/// A machine with bodies, and with a clamp beside its table, over the arms: its inner face at X 131.
MachineDescription with_clamp(bool has_bodies) {
  MachineDescription d = legs_below();
  d.bodies->fixed.push_back({"clamp", {131, -15, 1275}, {160, 15, 1299}});
  if (!has_bodies) d.bodies.reset();
  return d;
}

ProblemList problems_on(const MachineDescription& d, const std::string& job) {
  const auto its_kinematics = make_kinematics(d);
  StringSource source(job);
  Preflight preflight(d, **its_kinematics, source, (*its_kinematics)->bed_reference());
  while (!preflight.step(1000)) {
  }
  return preflight.problems();
}

TEST(Preflight, TwoBodiesThatMeetAreNamedWithTheLineAndTheSamePathBesideThemPasses) {
  const MachineDescription d = with_clamp(true);
  // The platform goes to +X as the tool goes to -X on the part: the disc of 100 mm comes to 2 mm from the
  // clamp at X -29.
  const ProblemList bad = problems_on(d, "G1 Z20 F6000\nG1 X-10\nG1 X-40\nG1 X0\nG1 X-40\n");
  ASSERT_EQ(bad.errors(), 2u);
  EXPECT_EQ(bad.all()[0].line, 3u);
  EXPECT_TRUE(bad.all()[0].words.starts_with("table and clamp would")) << bad.all()[0].words;
  EXPECT_EQ(bad.all()[1].line, 5u);
  EXPECT_EQ(problems_on(d, "G1 Z20 F6000\nG1 X-10\nG1 X-28\nG1 X0\nG1 X-28\n").errors(), 0u);
  EXPECT_EQ(problems_on(with_clamp(false), "G1 Z20 F6000\nG1 X-10\nG1 X-40\n").errors(), 0u)
      << "without [bodies] nobody knows of the clamp";
}

TEST(Preflight, MacrosOfTheMachineFileAreCarriedOutWithTheirArguments) {
  MachineDescription d = machine();
  d.macros = {{"Start_Print", "G1 X0 Y0 F6000\no1 repeat [#<times>]\nG91\nG1 X60\nG90\no1 endrepeat\n"},
              {"broken", "G1 X0\nG1 X\n"}};
  EXPECT_EQ(problems_on(d, "START_PRINT TIMES=2\nG1 X0\n").errors(), 0u);
  const ProblemList far = problems_on(d, "G1 X0 F6000\nSTART_PRINT TIMES=3\nG1 X0\n");
  ASSERT_EQ(far.errors(), 1u) << "X 180 is out of reach";
  EXPECT_EQ(far.all()[0].line, 2u);
  const ProblemList wrong = problems_on(d, "G1 X0 F6000\nM98 P\"BROKEN\"\n");
  ASSERT_EQ(wrong.errors(), 1u);
  EXPECT_EQ(wrong.all()[0].line, 2u);
  EXPECT_TRUE(wrong.all()[0].words.starts_with("in the macro broken, line 2: ")) << wrong.all()[0].words;
}

TEST(Preflight, NothingOfAMacroThatCannotBeReadIsCarriedOut) {
  MachineDescription d = machine();
  d.macros = {{"half", "G1 X500 F6000\no1 if [1]\n"}};
  const ProblemList problems = problems_on(d, "HALF\no2 repeat [1]\nG1 X10 F6000\no2 endrepeat\n");
  ASSERT_EQ(problems.errors(), 1u);
  EXPECT_EQ(problems.all()[0].words, "in the macro half, line 2: o1 if has no end");
}

TEST(Preflight, ATiltThatBringsTheTableUpAgainstTheNozzleHolderIsNamed) {
  MachineDescription d = legs_below();
  d.bodies->holder_radius_mm = 45;
  const ProblemList bad = problems_on(d, "G43.4\nG1 Z1 F3000\nG1 A45\n");
  ASSERT_EQ(bad.errors(), 1u);
  EXPECT_EQ(bad.all()[0].line, 3u);
  EXPECT_TRUE(bad.all()[0].words.starts_with("table and nozzle holder would")) << bad.all()[0].words;
  EXPECT_EQ(problems_on(d, "G43.4\nG1 Z30 F3000\nG1 A45\n").errors(), 0u);
}

TEST(Preflight, ACornerOfThePlatformAgainstTheNozzleIsNamedWithItsLineAndPasses2MmBesideIt) {
  // Tilted, past the corner where leg 3 carries the platform: once 1 mm from its rods, once 3 mm.
  const auto past_the_corner = [](const char* z) {
    return "G43.4\nG1 Z60 F3000\nG1 A45\nG1 X-124 Y-40\nG1 Z" + std::string(z) + "\nG1 Y-80\nG1 Z60\n";
  };
  const ProblemList bad = problems_on(default_m1(), past_the_corner("2"));
  ASSERT_EQ(bad.errors(), 1u);
  EXPECT_EQ(bad.all()[0].line, 6u);
  EXPECT_TRUE(bad.all()[0].words.starts_with("leg 3 and nozzle would come as near as "))
      << bad.all()[0].words;
  EXPECT_EQ(problems_on(default_m1(), past_the_corner("4")).errors(), 0u);
}

/// M1 with its left legs joined so near to each other that at 40 deg and the workspace's top one comes to the
/// platform's corner at the other. On M1 itself the platform keeps 57 mm from every leg that it does not
/// carry there (bodies/tests/platform_corner_test.cpp).
MachineDescription near_left_legs() {
  MachineDescription d = default_m1();
  auto& g = std::get<M1Geometry>(d.kinematics);
  for (const std::size_t leg : {2u, 3u}) {
    const double side = leg == 2 ? -1 : 1;
    g.legs[leg].attachment_mm[1] = 18 * side;
    g.legs[leg].foot_mm[1] = 201 * side;
  }
  d.bodies->fixed.clear();  // the columns stand behind M1's own rails
  return d;
}

TEST(Preflight, ACornerOfThePlatformAgainstALegIsNamedWithItsLineAndPasses2MmBesideIt) {
  const auto to = [](const char* y) {
    return "G43.4\nG1 Z200 F3000\nG1 A40\nG1 X10 Y-60\nG1 Y" + std::string(y) + "\nG1 Y0\n";
  };
  const ProblemList bad = problems_on(near_left_legs(), to("-86"));
  ASSERT_EQ(bad.errors(), 1u);
  EXPECT_EQ(bad.all()[0].line, 5u);
  EXPECT_TRUE(bad.all()[0].words.starts_with("platform and leg 4 would come as near as "))
      << bad.all()[0].words;
  EXPECT_EQ(problems_on(near_left_legs(), to("-84")).errors(), 0u);
  EXPECT_EQ(problems_on(default_m1(), to("-86")).errors(), 0u) << "M1 has room there";
}

/// A wall along X from -half to half that stands at `y`, in layers of 0.5 mm; the tool ends 20 mm above it.
/// It is `layers` high.
std::string wall(double y, int layers, int half = 10) {
  const std::string x = std::to_string(half);
  std::string job = "G43.4\nM83\nG1 Z20 F6000\nG1 X-" + x + " Y" + std::to_string(y) + "\n";
  for (int i = 1; i <= layers; ++i)
    job += "G1 Z" + std::to_string(0.5 * i) + "\nG1 X" + (i % 2 == 0 ? "-" : "") + x + " E1\n";
  return job + "G1 Z" + std::to_string(0.5 * layers + 20) + "\n";
}

std::uint32_t lines_in(const std::string& job) {
  return static_cast<std::uint32_t>(std::count(job.begin(), job.end(), '\n'));
}

TEST(Preflight, ATravelThroughWhatTheJobHasPrintedIsRefusedWithItsLineAndOneOverItIsNot) {
  const std::string printed = wall(0, 24), travel = "G1 X0 Y30\nG1 Z3\nG1 Y-30\n";
  const ProblemList bad = problems_on(legs_below(), printed + travel);
  ASSERT_EQ(bad.errors(), 1u);
  EXPECT_EQ(bad.all()[1].line, lines_in(printed) + 3);
  EXPECT_EQ(bad.all()[1].words, "nozzle and part on the table would touch");
  EXPECT_EQ(problems_on(legs_below(), printed + "G1 X0 Y30\nG1 Z12\nG1 Y-30\n").errors(), 0u);
  EXPECT_EQ(problems_on(legs_below(), "G43.4\nG1 Z20 F6000\n" + travel).errors(), 0u)
      << "nothing was printed";
  MachineDescription blind = legs_below();
  blind.bodies->printed_part = false;
  EXPECT_EQ(problems_on(blind, printed + travel).errors(), 0u);
}

TEST(Preflight, ATiltThatLeansTheNozzleHolderAgainstWhatWasPrintedBeforeIsRefused) {
  const std::string printed = wall(45, 120);  // 60 mm high
  const std::string beside = "G1 X0 Y0\nG1 Z5\n";
  const ProblemList bad = problems_on(legs_below(), printed + beside + "G1 A40\n");
  ASSERT_EQ(bad.errors(), 1u);
  EXPECT_EQ(bad.all()[1].line, lines_in(printed) + 3);
  EXPECT_EQ(bad.all()[1].words, "nozzle holder and part on the table would touch");
  const ProblemList good = problems_on(legs_below(), printed + beside + "G1 A-40\n");
  EXPECT_EQ(good.errors(), 0u) << good.all()[1].words;
}

/// What is wrong with a job that prints a wall and then goes to `y` beside it, 2 mm above the table.
void expect_met(const MachineDescription& d, const std::string& printed, double y, const char* first) {
  const std::string job = printed + "G1 X0 Y-60\nG1 Z2\nG1 Y" + std::to_string(y) + "\n";
  const ProblemList problems = problems_on(d, job);
  if (first == nullptr) {
    EXPECT_EQ(problems.errors(), 0u) << problems.all().back().words;
    return;
  }
  ASSERT_EQ(problems.errors(), 1u);
  EXPECT_EQ(problems.all().back().line, lines_in(job));
  EXPECT_TRUE(problems.all().back().words.starts_with(std::string(first) + " and part on the table would"))
      << problems.all().back().words;
}

TEST(Preflight, WhatTheMachineHasBesidesToolAndHolderKeepsOutOfWhatTheJobHasPrinted) {
  const auto delta = load_machine(machines_folder() / "delta.toml");
  ASSERT_TRUE(delta) << to_string(delta.error());
  // 60 mm high at Y 60. The effector's edge, 30 mm from the tool's axis, is 32 mm above the table.
  const std::string post = wall(60, 120);
  expect_met(*delta, post, 29.8, "platform");
  expect_met(*delta, post, 28, nullptr);
  // Wider, and the rods of the third arm are at it before.
  const std::string wide = wall(60, 120, 30);
  expect_met(*delta, wide, 20, "leg 3");
  expect_met(*delta, wide, 0, nullptr);
  expect_met(*delta, wall(60, 40, 30), 20, nullptr);  // it is lower than the arms are
  // The table carries it: towards a clamp in the frame, whose inner face is at Y 131, the tool at Y -71.
  MachineDescription m1 = legs_below();
  m1.bodies->fixed.push_back({"clamp", {-15, 131, 1310}, {15, 160, 1340}});
  expect_met(m1, post, -70.9, "clamp");
  expect_met(m1, post, -69, nullptr);
  m1.bodies->printed_part = false;
  expect_met(m1, post, -72, nullptr);
}

TEST(Preflight, WhatThePlatformCarriesIsCheckedAgainstATableThatStands) {
  MachineDescription d = legs_below();
  auto& g = std::get<M1Geometry>(d.kinematics);
  // Upside down, with the tool on the platform and the table in the frame.
  g.tool = ToolPlacement::kPlatform;
  g.nozzle_mm = {0, 0, -180};
  g.table_mm = {0, 0, 60};
  for (std::size_t i = 0; i < 4; ++i) {
    g.legs[i].foot_mm[2] = 1020;
    g.legs[i].attachment_mm[2] = 5;
    g.legs[i].carriage_above = true;
    d.joints[i].homing->method = 20;
    d.joints[i].homing->switch_position = d.joints[i].travel.max;
  }
  const std::string job = "G43.4\nG1 Z1 F3000\nG1 A45\nG1 A-45\nG1 X30 Y-20 C90 A20\n";
  const ProblemList good = problems_on(d, job);
  EXPECT_EQ(good.errors(), 0u) << good.all()[0].words;
  // A spindle so wide that its face meets the table when it leans.
  d.bodies->holder_radius_mm = 45;
  const ProblemList bad = problems_on(d, job);
  ASSERT_GE(bad.errors(), 1u);
  EXPECT_EQ(bad.all()[0].line, 3u);
  EXPECT_TRUE(bad.all()[0].words.starts_with("table and nozzle holder would")) << bad.all()[0].words;
}

TEST(WayRules, WhatIsMetBetweenTwoPosesThatAreClearIsFound) {
  const MachineDescription d = with_clamp(true);
  const auto its_kinematics = make_kinematics(d);
  WayRules way(d, **its_kinematics);
  // Past the clamp in one step of 160 mm; and the same 20 mm farther from it.
  for (const auto& [x, meets] : {std::pair{-40.0, true}, std::pair{-20.0, false}}) {
    const auto at = [x = x](double s) { return Pose{x, -80 + 160 * s, 20, 0, 0, 0}; };
    way.jump();
    EXPECT_FALSE(way.broken(Frame::kMachine, 0, 0, at));
    const auto words = way.broken(Frame::kMachine, 0, 1, at);
    EXPECT_EQ(words.has_value(), meets) << words.value_or(Sentence{});
    if (words) {
      EXPECT_TRUE(words->starts_with("table and clamp would")) << *words;
    }
    way.jump();
    EXPECT_FALSE(way.broken(Frame::kMachine, 1, 1, at));
  }
}

TEST(Preflight, TiltBeyondTheLimitIsReported) {
  EXPECT_EQ(check("G1 A44 Z60 F3000\n").problems.errors(), 0u);
  const Checked c = check("G1 Z60 F3000\nG1 A50\n");
  ASSERT_GE(c.problems.errors(), 1u);
  EXPECT_EQ(c.problems.all()[0].line, 2u);
}

TEST(Preflight, TemperatureOutOfRangeIsAnError) {
  const Checked c = check("M104 S500\nM140 S60\nM190 S130\n");
  ASSERT_EQ(c.problems.errors(), 2u);
  EXPECT_EQ(c.problems.all()[0].line, 1u);
  EXPECT_EQ(c.problems.all()[1].line, 3u);
}

TEST(Preflight, ColdExtrusionIsAnErrorOnce) {
  const Checked c = check("M104 S100\nM83\nG1 X10 E1 F1200\nG1 X20 E1\n");
  ASSERT_EQ(c.problems.errors(), 1u);
  EXPECT_EQ(c.problems.all()[0].line, 3u);
}

TEST(Preflight, ExtrusionWithoutAnyTemperatureIsOnlyWarnedOf) {
  const Checked c = check("M83\nG1 X10 E1 F1200\n");
  EXPECT_EQ(c.problems.errors(), 0u);
  EXPECT_EQ(c.problems.warnings(), 1u);
}

TEST(Preflight, WhatHasNoEffectHereIsWarnedOfOnce) {
  const Checked c = check("G29\nG1 X10 F1200\nG29\nM205 J0.1\nM205 J0.2\n");
  EXPECT_EQ(c.problems.errors(), 0u);
  ASSERT_EQ(c.problems.warnings(), 2u);
  EXPECT_EQ(c.problems.all()[0].line, 1u);
  EXPECT_EQ(c.problems.all()[0].words, "G29 has no effect: the machine file has no [probe]");
  EXPECT_EQ(c.problems.all()[1].line, 4u);
}

TEST(Preflight, ListOfProblemsIsCappedAndCountsOn) {
  std::string job;
  for (int i = 0; i < 1000; ++i)
    job += "G" + std::to_string(100 + i / 10) + "." + std::to_string(i % 10) + "\n";
  const Checked c = check(job);
  EXPECT_EQ(c.problems.errors(), 1000u);
  EXPECT_EQ(c.problems.all().size(), 300u);
  EXPECT_TRUE(c.problems.truncated());
}

TEST(Preflight, RefusalsInTheSameWordsAreToldOnceAndCounted) {
  std::string job;
  for (int i = 0; i < 1192; ++i) job += "G1 X1 Q\n";
  const Checked c = check(job);
  ASSERT_EQ(c.problems.errors(), 2u);
  EXPECT_EQ(c.problems.all()[0].line, 1u);
  EXPECT_EQ(c.problems.all()[1].words, "1191 more lines are refused for reasons named above");
}

TEST(Preflight, LinesThatEndWithReturnsAloneAreRead) {
  const Checked c = check("G1 X10 F3000\rG1 X5000\rG1 X0\rG199\rG4 S2\r");
  ASSERT_EQ(c.problems.errors(), 2u);
  EXPECT_EQ(c.problems.all()[0].line + c.problems.all()[1].line, 2u + 4u);
  EXPECT_NEAR(c.report.dwell_s, 2, 1e-9);
}

TEST(Preflight, DwellsAndWaitsAreCounted) {
  const Checked c = check("G4 S2\nM109 S200\nM0\nG1 X1 F600\n");
  EXPECT_NEAR(c.report.dwell_s, 2, 1e-9);
  EXPECT_EQ(c.report.heat_waits, 1u);
  EXPECT_EQ(c.report.pauses, 1u);
  EXPECT_EQ(c.report.runs, 1u);
}

}  // namespace
}  // namespace kinebus
