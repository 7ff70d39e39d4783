// The extruder's limits over random jobs, advances, windows and shapers, measured from the positions that the
// plan takes. With a shaper flow has a sharp bend where the tip turns about, which no limit of jerk can hold.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "gateway/jobs/job_pipeline.hpp"
#include "gateway/jobs/machine_setup.hpp"
#include "gateway/jobs/tests/job_support.hpp"

namespace kinebus {
namespace {

using Step = JobPipeline::Step;

double in(double low, double high) {
  return low + (high - low) * static_cast<double>(*rc::gen::inRange<std::uint64_t>(0, 1ull << 53)) * 0x1p-53;
}
int among(int count) {
  return *rc::gen::inRange(0, count);
}

std::string num(double value) {
  return printed("%.5f", value);
}

/// Beads, travels, retractions, wipes and other advances in any order. `gentle`: without sharp turns.
std::string random_job(bool keeps_window, bool gentle) {
  std::string text = "G21 G90 M83\nM104 S210\nG1 Z5 F6000\nG1 E1 F600\n";
  double x = 0, y = 0;
  const auto go = [&](double by, double heading) {
    x = std::clamp(x + by * std::cos(heading), -40.0, 40.0);
    y = std::clamp(y + by * std::sin(heading), -40.0, 40.0);
    return " X" + num(x) + " Y" + num(y);
  };
  const int moves = *rc::gen::inRange(3, 40);
  double heading = in(0, 6.28);
  for (int i = 0; i < moves; ++i) {
    heading += !gentle && among(3) == 0 ? in(-3.2, 3.2) : in(-0.2, 0.2);
    const double length = std::exp(in(std::log(0.05), std::log(gentle ? 1.0 : 20.0)));
    const double feed = std::exp(in(std::log(300.0), std::log(12000.0)));
    switch (among(10)) {
      case 0:
        text += "G1 E" + num(in(-2, 2)) + " F" + num(in(300, 3600)) + "\n";
        break;
      case 1:
        text += "G0" + go(length, heading) + "\n";
        break;
      case 2:
        text += "G1" + go(length, heading) + " E" + num(-in(0, 0.1) * length) + " F" + num(feed) + "\n";
        break;
      case 3:
        text += "M572 S" + num(among(3) == 0 ? 0 : in(0, 0.12)) + "\n";
        break;
      case 4:
        if (!keeps_window) text += "SET_PRESSURE_ADVANCE SMOOTH_TIME=" + num(in(0.002, 0.06)) + "\n";
        break;
      default:
        text += "G1" + go(length, heading) + " E" + num(in(0, 0.12) * length) + " F" + num(feed) + "\n";
    }
  }
  return text;
}

MachineDescription random_machine() {
  MachineDescription machine = default_m1();
  constexpr std::array<ShaperKind, 4> kKinds{ShaperKind::kNone, ShaperKind::kMzv, ShaperKind::kEi,
                                             ShaperKind::kTwoHump};
  machine.vibration.every = {kKinds[static_cast<std::size_t>(among(4))], in(25, 80), in(0.02, 0.2)};
  if (machine.vibration.every.shaper == ShaperKind::kNone) machine.vibration.every = {};
  AdvanceModel& model = machine.pressure_advance;
  model.kind = static_cast<AdvanceKind>(among(3));
  model.advance_s = among(4) == 0 ? 0 : in(0.001, 0.1);
  if (model.kind != AdvanceKind::kLinear) {
    model.nonlinear_mm = in(0, 0.2);
    model.nonlinear_mm_per_s = in(0.5, 5);
  }
  model.melt_s = among(2) == 0 ? 0 : in(0.001, 0.02);
  model.smooth_s = in(0.004, 0.05);
  for (JointDescription& joint : machine.joints)
    if (joint.name == "E") {
      joint.speed_per_s = in(20, 80);
      joint.accel_per_s2 = in(500, 5000);
    }
  machine.path.tool_jerk_mm_per_s3 = among(2) == 0 ? 0 : in(2e4, 2e5);
  return machine;
}

struct Ratios {
  double speed = 0, accel = 0, jerk = 0, step_mm = 0;
  std::string refused;
};

/// Positions of one joint each millisecond, from rest to rest; jerk by third differences.
class EachMillisecond {
 public:
  void add(const Phase& phase) {
    for (; next_s_ <= now_s_ + phase.duration_s; next_s_ += 1e-3)
      places_.push_back(phase.at(next_s_ - now_s_).x[kE]);
    now_s_ += phase.duration_s;
  }
  double end() {
    double most = 0;
    for (std::size_t i = 3; i < places_.size(); ++i)
      most = std::max(most, std::abs(places_[i] - 3 * places_[i - 1] + 3 * places_[i - 2] - places_[i - 3]));
    *this = {};
    return most * 1e9;
  }

 private:
  std::vector<double> places_;
  double now_s_ = 0, next_s_ = 0;
};

/// What E does: its speed and its mean acceleration by phases, its jerk.
Ratios measure(const MachineDescription& machine, const Kinematics& kinematics, const std::string& job) {
  const auto extruder = std::find_if(machine.joints.begin(), machine.joints.end(),
                                     [](const JointDescription& joint) { return joint.name == "E"; });
  constexpr double kShortest_s = 50e-6;
  Ratios worst;
  StringSource source(job);
  JobPipeline pipeline(machine, kinematics);
  pipeline.start_job(source, kinematics.bed_reference());
  const double jerk_limit = joint_jerk_limit(machine, *extruder);
  EachMillisecond each_ms;
  double end_e = 0, end_speed = 0;
  bool joins = false;
  for (;;) {
    int budget = 1'000'000;
    const Step step = pipeline.next(budget);
    if (step == Step::kProblem)
      worst.refused =
          "line " + std::to_string(pipeline.problem().line) + ": " + pipeline.problem().words.english();
    if (step != Step::kPhase) worst.jerk = std::max(worst.jerk, each_ms.end() / jerk_limit);
    if (step == Step::kEnd || step == Step::kProblem) break;
    if (step == Step::kRunEnd) {
      joins = false;
    }
    if (step != Step::kPhase) continue;
    const Phase& phase = pipeline.phase();
    const PosePoint from = phase.at(0), to = phase.at(phase.duration_s);
    each_ms.add(phase);
    if (joins) {
      worst.step_mm = std::max(worst.step_mm, std::abs(from.x[kE] - end_e));
      const double within = std::max(phase.duration_s, 0.5e-3) * extruder->accel_per_s2;
      worst.accel = std::max(worst.accel, std::abs(from.x1[kE] - end_speed) / within);
    }
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
      worst.speed =
          std::max(worst.speed, std::abs(phase.at(share * phase.duration_s).x1[kE]) / extruder->speed_per_s);
    if (phase.duration_s > kShortest_s)
      worst.speed =
          std::max(worst.speed, std::abs(to.x[kE] - from.x[kE]) / phase.duration_s / extruder->speed_per_s);
    if (phase.duration_s > kShortest_s)
      worst.accel = std::max(worst.accel,
                             std::abs(to.x1[kE] - from.x1[kE]) / phase.duration_s / extruder->accel_per_s2);
    end_e = to.x[kE];
    end_speed = to.x1[kE];
    joins = true;
  }
  return worst;
}

void expect_within_limits(const MachineDescription& machine, const std::string& job, bool gentle) {
  const Ratios ratios = measure(machine, job_test::kinematics(), job);
  const VibrationDescription& vibration = machine.vibration;
  const AdvanceModel& model = machine.pressure_advance;
  RC_LOG() << job << "shaper " << static_cast<int>(vibration.every.shaper) << " "
           << vibration.every.frequency_hz << " Hz; model " << static_cast<int>(model.kind) << " "
           << model.advance_s << " s " << model.nonlinear_mm << " mm " << model.nonlinear_mm_per_s
           << " mm/s, melt " << model.melt_s << " s, window " << model.smooth_s << " s; tool's jerk "
           << machine.path.tool_jerk_mm_per_s3 << "\nspeed " << ratios.speed << " accel " << ratios.accel
           << " jerk " << ratios.jerk << " step " << ratios.step_mm << "\n";
  RC_ASSERT(ratios.refused == "");
  RC_ASSERT(ratios.step_mm <= 1e-7);
  RC_ASSERT(ratios.speed <= 1.0);
  RC_ASSERT(ratios.accel <= 1.0);
  if (gentle || !vibration.shapes()) RC_ASSERT(ratios.jerk <= 1.0);
}

TEST(ExtruderLimits, HoldForAnyAdvanceWindowShaperAndJob) {
  EXPECT_TRUE(rc::check([] {
    for (int n = 0; n < 10; ++n) {
      const bool gentle = among(2) == 0;
      expect_within_limits(random_machine(), random_job(among(2) == 0, gentle), gentle);
    }
  }));
}

/// Corners that shaping cuts off leave E short of its plan: it goes on from there, whatever follows.
TEST(ExtruderLimits, HoldWhereTheAdvanceEndsBehindCornersThatWereCutOff) {
  MachineDescription machine = default_m1();
  machine.vibration.every = {ShaperKind::kMzv, 30, 0.1};
  machine.pressure_advance = {.advance_s = 0.05};
  for (JointDescription& joint : machine.joints)
    if (joint.name == "E") joint.speed_per_s = 10;
  std::string job = "G21 G90 M83\nM104 S210\nG1 Z5 F6000\nG1 E1 F400\n";
  for (int i = 0; i < 40; ++i)
    job += "G1 X" + num(i % 2 == 0 ? 20 : -20) + " Y" + num(0.5 * i) + " E4 F3000\n";
  for (const std::string last : {"M572 S0\n", "M572 S0\nM593 F0\n", "M572 S0\nM593 F45\n", "M593 F0\n",
                                 "M572 S0\nSET_PRESSURE_ADVANCE SMOOTH_TIME=0.03\n"}) {
    const Ratios ratios =
        measure(machine, job_test::kinematics(), job + last + "G1 X0 Y0 E2 F3000\nG1 X10 E0.5\n");
    EXPECT_EQ(ratios.refused, "") << last;
    EXPECT_LE(ratios.speed, 1.0) << last;
    EXPECT_LE(ratios.accel, 1.0) << last;
  }
}

/// Found by random jobs: a bead with another advance right behind one, without a shaper, while the window
/// still had the advance of the one before.
TEST(ExtruderLimits, HoldWhereTheAdvanceChangesBetweenTwoBeads) {
  struct Case {
    AdvanceModel model;
    double speed, accel;
    std::string job;
  };
  const std::string begin = "G21 G90 M83\nM104 S210\nG1 Z5 F6000\nG1 E1 F600\n";
  const std::vector<Case> cases = {
      {{.advance_s = 0.0745159, .smooth_s = 0.00593569},
       44.5347,
       507.687,
       "G1 X0.63129 Y4.27342 F1783\nG1 X0.67456 Y4.23880 E0.00233 F742.69235\nM572 S0.01038\n"
       "G1 X0.84533 Y4.07980 E0.01244 F1005.56981\n"},
      {{.advance_s = 0.0261392, .smooth_s = 0.0157729},
       58.5359,
       531.152,
       "G1 X0.02965 Y-0.80789 E0.02860 F1058.20479\nM572 S0.00579\n"
       "G1 X0.41428 Y-1.32248 E0.05639 F3468.58321\n"},
      {{.advance_s = 0.094665, .melt_s = 0.00925628, .smooth_s = 0.046527},
       53.1235,
       2289.64,
       "G1 X-12.33527 Y40 E1.69726 F819.97203\nM572 S0.02722\nG1 X-12.86557 Y40 E0.11243 F5042.52999\n"
       "M572 S0\nG1 X-12.88378 Y40 E0.00324 F3135.68806\nG1 X-12.84885 Y40 E0.04924 F9075.97768\n"},
  };
  for (const Case& c : cases) {
    MachineDescription machine = default_m1();
    machine.pressure_advance = c.model;
    for (JointDescription& joint : machine.joints)
      if (joint.name == "E") {
        joint.speed_per_s = c.speed;
        joint.accel_per_s2 = c.accel;
      }
    const Ratios ratios = measure(machine, job_test::kinematics(), begin + c.job);
    EXPECT_EQ(ratios.refused, "") << c.job;
    EXPECT_LE(ratios.accel, 1.0) << c.job;
    EXPECT_LE(ratios.speed, 1.0) << c.job;
  }
}

}  // namespace
}  // namespace kinebus
