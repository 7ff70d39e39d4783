// Threads: where the motors are, against the angle that the simulated spindle's encoder tells. The spindle
// droops under a load that the planner knows nothing of.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "gateway/machine/tests/machine_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kPitch_mm = 1.5;

MachineDescription lathe() {
  const auto machine = load_machine(machines_folder() / "cartesian.toml");
  EXPECT_TRUE(machine.has_value());
  MachineDescription lathe = machine ? *machine : MachineDescription{};
  lathe.heaters.clear();
  lathe.fans.clear();
  lathe.spindle = {.present = true,
                   .min_rpm = 100,
                   .max_rpm = 3000,
                   .reversible = true,
                   .encoder_counts = 4096,
                   .sim_rpm_per_s = 6000,
                   .sim_droop_percent = 12,
                   .sim_load_s = 0.7};
  return lathe;
}

/// Where the thread begins, mm at angle 0: what each moment within the cut says, one row a pass.
struct Pass {
  double least = 1e9, most = -1e9;
  double sum = 0;
  int count = 0;
  double mean() const { return sum / count; }
};

class Threads : public ::testing::Test {
 protected:
  explicit Threads(MachineDescription machine = lathe()) : rig(std::move(machine)) {}

  bool begin(const std::string& text) {
    if (rig.gateway->state() != MachineState::kReady && !rig.make_ready()) return false;
    return rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(text), "thread"}).has_value();
  }
  /// To its end, or until `enough`. Looks at X from `from` to `to` while it grows.
  bool cut(double from, double to, const std::function<bool()>& enough = {}) {
    double before = rig.joints()[0];
    std::optional<Pass> pass;
    const bool ended = rig.run_until(
        [&] {
          const SpindleStatus spindle = rig.gateway->status().spindle;
          const double x = rig.joints()[0];
          const bool grows = x > before;
          if (spindle.angle && spindle.angle->at == rig.now && grows && x > from && x < to) {
            if (!pass) pass.emplace();
            const double start = x - kPitch_mm * spindle.angle->turns;
            pass->least = std::min(pass->least, start);
            pass->most = std::max(pass->most, start);
            pass->sum += start;
            ++pass->count;
            slowest_rpm = std::min(slowest_rpm, spindle.actual_rpm);
            fastest_rpm = std::max(fastest_rpm, spindle.actual_rpm);
          } else if (pass && x < from) {
            passes.push_back(*pass);
            pass.reset();
          }
          before = x;
          if (enough && enough()) return true;
          return rig.gateway->state() == MachineState::kReady;
        },
        120s);
    if (pass) passes.push_back(*pass);
    return ended;
  }

  MachineRig rig;
  std::vector<Pass> passes;
  double slowest_rpm = 1e9, fastest_rpm = 0;
};

// Three passes from one place, a slower one among them.
constexpr const char* kThreePasses =
    "M3 S600\nG0 X0\nG33 X40 K1.5\nG0 Y1\nX0\nY0\nS450\nG33 X40 K1.5\nG0 Y1\nX0\nY0\nS600\n"
    "G33 X40 K1.5\nG0 Y1\n";

TEST_F(Threads, PitchAndAngleStayRightWhileTheSpindleDroops) {
  ASSERT_TRUE(begin(kThreePasses));
  ASSERT_TRUE(cut(3, 37)) << rig.story();
  ASSERT_EQ(passes.size(), 3U) << rig.story();
  EXPECT_LT(slowest_rpm, 0.92 * 450) << "or nothing was to be followed";
  EXPECT_GT(fastest_rpm, 595);
  for (const Pass& pass : passes) {
    const double beside = (pass.mean() - passes[0].mean()) / kPitch_mm;
    std::printf("%d looks, pitch within %.1f um, beside the first pass by %.1f um\n", pass.count,
                1000 * std::max(pass.most - pass.mean(), pass.mean() - pass.least),
                1000 * kPitch_mm * (beside - std::round(beside)));
    EXPECT_GT(pass.count, 300);
    EXPECT_LT(pass.most - pass.least, 0.030);
  }
  // The run-in of the slower one is another plan.
  const double turns = (passes[2].mean() - passes[0].mean()) / kPitch_mm;
  EXPECT_NEAR(turns, std::round(turns), 0.002) << "the pass begins at another angle";
}

TEST_F(Threads, AHoldWaitsForTheEndOfThePassAndAnOverrideDoesNotCount) {
  ASSERT_TRUE(begin(kThreePasses));
  ASSERT_TRUE(cut(3, 37, [&] { return rig.joints()[0] > 10; })) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetFeedOverride{0.4}));
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld)) << rig.story();
  EXPECT_NEAR(rig.joints()[0], 40, 0.01);
  rig.run_for(1s);
  EXPECT_NEAR(rig.joints()[0], 40, 0.01);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  passes.clear();
  ASSERT_TRUE(cut(3, 37)) << rig.story();
  ASSERT_EQ(passes.size(), 2U);
  for (const Pass& pass : passes) EXPECT_LT(pass.most - pass.least, 0.030);
}

TEST_F(Threads, AStopRestsWithinThePassAndTheJobDoesNotGoOn) {
  ASSERT_TRUE(begin(kThreePasses));
  ASSERT_TRUE(cut(3, 37, [&] { return rig.joints()[0] > 10; })) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped)) << rig.story();
  EXPECT_LT(rig.joints()[0], 13);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  EXPECT_FALSE(rig.gateway->carry_out(command::Resume{}));
  EXPECT_NE(rig.story().find("it was stopped in a thread"), std::string::npos) << rig.story();
}

TEST_F(Threads, ACancelRestsWithinThePass) {
  ASSERT_TRUE(begin(kThreePasses));
  ASSERT_TRUE(cut(3, 37, [&] { return rig.joints()[0] > 10; })) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  EXPECT_LT(rig.joints()[0], 15);
}

TEST_F(Threads, WhatTheMachineCannotFollowIsRefusedBeforeAnythingMoves) {
  for (const auto& [text, words] :
       {std::pair{"M3 S3000\nG33 X40 K10\n", "the thread needs 550 mm/s at 3300 rpm"},
        std::pair{"M3 S3000\nG33 X0.1 K1.5\n", "more way before and behind the thread"},
        std::pair{"G33 X40 K1.5\n", "G33 needs the spindle to turn"}}) {
    ASSERT_TRUE(begin(text));
    const double x = rig.joints()[0];
    ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
    EXPECT_NE(rig.story().find(words), std::string::npos) << rig.story();
    EXPECT_NEAR(rig.joints()[0], x, 1e-3);
  }
}

MachineDescription tapping_machine() {
  MachineDescription machine = lathe();
  machine.spindle.tap_rpm_per_s = 3000;
  return machine;
}

class Taps : public Threads {
 protected:
  Taps() : Threads(tapping_machine()) {}

  /// Looks at each moment of one tap along X, from 0 to `deep` and back, between `from` and `deep`.
  struct Looks {
    int in = 0, out = 0;
    double error_mm = 0;       ///< tool against the spindle's angle, at most
    double turn_error_mm = 0;  ///< of that while the spindle turned slower than half of S
    double deepest_mm = 0;
    double slowest_rpm = 1e9, back_rpm = 0;
  };
  Looks tap(double from, double pitch, const std::function<bool()>& enough = {}) {
    Looks looks;
    double told = 0, angle = 0, sum = 0;
    std::vector<std::pair<double, double>> errors;  // place beside the angle, rpm
    const bool ended = rig.run_until(
        [&] {
          const SpindleStatus spindle = rig.gateway->status().spindle;
          const double x = rig.joints()[0];
          if (spindle.angle && spindle.angle->at == rig.now) {
            angle += (spindle.actual_rpm < 0 ? -1 : 1) * (spindle.angle->turns - told);
            told = spindle.angle->turns;
            if (x > from) {
              ++(spindle.actual_rpm < 0 ? looks.out : looks.in);
              errors.emplace_back(x - pitch * angle, spindle.actual_rpm);
              looks.slowest_rpm = std::min(looks.slowest_rpm, std::abs(spindle.actual_rpm));
              looks.back_rpm = std::min(looks.back_rpm, spindle.actual_rpm);
            }
          }
          looks.deepest_mm = std::max(looks.deepest_mm, x);
          if (enough && enough()) return true;
          return rig.gateway->state() == MachineState::kReady;
        },
        60s);
    EXPECT_TRUE(ended) << rig.story();
    for (const auto& [start, rpm] : errors) sum += start;
    const double mean = sum / static_cast<double>(std::max<std::size_t>(1, errors.size()));
    for (const auto& [start, rpm] : errors) {
      looks.error_mm = std::max(looks.error_mm, std::abs(start - mean));
      if (std::abs(rpm) < 300) looks.turn_error_mm = std::max(looks.turn_error_mm, std::abs(start - mean));
    }
    std::printf(
        "in %d, out %d looks, within %.1f um, while turning back %.1f um; deepest %.4f mm, back %.0f rpm\n",
        looks.in, looks.out, 1000 * looks.error_mm, 1000 * looks.turn_error_mm, looks.deepest_mm,
        looks.back_rpm);
    return looks;
  }
};

TEST_F(Taps, TheToolTurnsBackWithTheSpindle) {
  ASSERT_TRUE(begin("M3 S600\nG0 X0\nG33.1 X20 K1.5\nG4 P0.5\n"));
  const Looks looks = tap(2, 1.5);
  EXPECT_GT(looks.in, 300);
  EXPECT_GT(looks.out, 300);
  EXPECT_LT(looks.slowest_rpm, 30) << "or it was not seen to turn back";
  EXPECT_LT(looks.back_rpm, -500);
  EXPECT_LT(looks.error_mm, 0.045);
  EXPECT_LT(looks.turn_error_mm, 0.020);
  EXPECT_NEAR(looks.deepest_mm, 20, 0.005);
  EXPECT_NEAR(rig.joints()[0], 0, 1e-3) << "it ends where it began";
}

TEST_F(Taps, ALeftHandedOneAndAFastFineOneAreAsGood) {
  ASSERT_TRUE(begin("M4 S400\nG0 X0\nG33.1 X14 K2\n"));
  EXPECT_TRUE(rig.run_until([&] { return rig.gateway->status().spindle.actual_rpm > 300; }, 20s))
      << "it turns back";
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  EXPECT_NEAR(rig.joints()[0], 0, 1e-3);
  ASSERT_TRUE(begin("M3 S1500\nG0 X0\nG33.1 X16 K0.5\nG4 P0.5\n"));
  const Looks looks = tap(2, 0.5);
  EXPECT_LT(looks.error_mm, 0.045);
  EXPECT_NEAR(looks.deepest_mm, 16, 0.005);
}

TEST_F(Taps, TheSpindleTurnsAsBeforeWhenTheNextLineMoves) {
  ASSERT_TRUE(begin("M3 S600\nG0 X0\nG33.1 X20 K1.5\nG1 Y5 F600\n"));
  ASSERT_TRUE(rig.run_until([&] { return rig.joints()[0] > 15; }, 20s));
  ASSERT_TRUE(rig.run_until([&] { return rig.joints()[1] > 0.05; }, 20s)) << rig.story();
  EXPECT_GT(rig.gateway->status().spindle.actual_rpm, 500);
}

TEST_F(Taps, AHoldWaitsUntilItIsOutAndACancelIsRefusedMeanwhile) {
  ASSERT_TRUE(begin("M3 S600\nG0 X0\nG33.1 X20 K1.5\nG1 Y5 F600\n"));
  ASSERT_TRUE(rig.run_until([&] { return rig.joints()[0] > 10; }, 20s));
  const auto cancelled = rig.gateway->carry_out(command::Cancel{});
  ASSERT_FALSE(cancelled);
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld)) << rig.story();
  EXPECT_NEAR(rig.joints()[0], 0, 0.01);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
}

TEST_F(Taps, AStopRestsInTheHoleAndEndsTheJob) {
  ASSERT_TRUE(begin("M3 S600\nG0 X0\nG33.1 X20 K1.5\n"));
  ASSERT_TRUE(rig.run_until([&] { return rig.joints()[0] > 10; }, 20s));
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped)) << rig.story();
  EXPECT_LT(rig.joints()[0], 13);
  EXPECT_NE(rig.story().find("it was stopped in a thread"), std::string::npos) << rig.story();
}

TEST_F(Taps, WhatHasNoRoomToTurnBackIsRefusedBeforeAnythingMoves) {
  for (const auto& [text, words] : {std::pair{"M3 S600\nG33.1 X4 K1.5\n", "the tap needs 4.7"},
                                    std::pair{"M3 S3000\nG33.1 X40 K10\n", "the thread needs 550 mm/s"},
                                    std::pair{"M3 S600\nG33.1 X40 K1.5 I3\n", "I of G33.1 is 1 at most"}}) {
    ASSERT_TRUE(begin(text));
    const double x = rig.joints()[0];
    ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
    EXPECT_NE(rig.story().find(words), std::string::npos) << rig.story();
    EXPECT_NEAR(rig.joints()[0], x, 1e-3);
  }
}

TEST_F(Taps, G84IsRigidWhereTheSpindleCanBeTurnedBack) {
  // G19 drills along X.
  ASSERT_TRUE(begin("M3 S600\nG0 X40\nG19 G84 X10 R30 F900\nG80\n"));
  double deepest = 1e9, worst = 0, told = 0, angle = 0, first = 0;
  bool begun = false;
  ASSERT_TRUE(rig.run_until([&] { return rig.joints()[0] > 39; }, 20s)) << rig.story();
  told = rig.gateway->status().spindle.angle->turns;
  ASSERT_TRUE(rig.run_until(
      [&] {
        const SpindleStatus spindle = rig.gateway->status().spindle;
        const double x = rig.joints()[0];
        deepest = std::min(deepest, x);
        if (!spindle.angle || spindle.angle->at != rig.now) return false;
        angle += (spindle.actual_rpm < 0 ? -1 : 1) * (spindle.angle->turns - told);
        told = spindle.angle->turns;
        if (x > 28 || deepest > 28) return rig.gateway->state() == MachineState::kReady;
        if (!std::exchange(begun, true)) first = x + 1.5 * angle;
        worst = std::max(worst, std::abs(x + 1.5 * angle - first));
        return rig.gateway->state() == MachineState::kReady;
      },
      60s))
      << rig.story();
  EXPECT_NEAR(deepest, 10, 0.005);
  EXPECT_LT(worst, 0.08) << "both ways";
  EXPECT_NEAR(rig.joints()[0], 40, 1e-3);
}

/// What is fed at each look, against the turns that the spindle makes meanwhile.
class FeedPerTurn : public Threads {
 protected:
  struct Cut {
    double mm = 0, turns = 0;
    double least = 1e9, most = 0;  ///< mm a turn over a quarter of a second
  };
  Cut cut_between(double from, double to) {
    Cut cut;
    std::optional<std::pair<double, double>> begin, mark;
    BusTime marked{0};
    EXPECT_TRUE(rig.run_until(
        [&] {
          const SpindleStatus spindle = rig.gateway->status().spindle;
          const double x = rig.joints()[0];
          if (!spindle.angle || spindle.angle->at != rig.now || x < from) return x > to;
          if (!begin) begin = mark = {x, spindle.angle->turns}, marked = rig.now;
          cut.mm = x - begin->first;
          cut.turns = spindle.angle->turns - begin->second;
          if (rig.now - marked >= 250ms) {
            const double feed = (x - mark->first) / (spindle.angle->turns - mark->second);
            cut.least = std::min(cut.least, feed);
            cut.most = std::max(cut.most, feed);
            mark = {x, spindle.angle->turns};
            marked = rig.now;
          }
          return x > to;
        },
        60s))
        << rig.story();
    std::printf("%.4f mm a turn in the mean, %.4f to %.4f over a quarter of a second\n", cut.mm / cut.turns,
                cut.least, cut.most);
    return cut;
  }
};

TEST_F(FeedPerTurn, FollowsTheSpeedThatIsMeasured) {
  ASSERT_TRUE(begin("M3 S600\nG0 X0\nG95 G1 X40 F0.5\nG94 G1 X60 F600\n"));
  const Cut cut = cut_between(2, 38);
  EXPECT_NEAR(cut.mm / cut.turns, 0.5, 0.002);
  EXPECT_GT(cut.least, 0.985 * 0.5);
  EXPECT_LT(cut.most, 1.015 * 0.5);
  // By the minute nothing is asked of the spindle.
  ASSERT_TRUE(rig.run_until([&] { return rig.joints()[0] > 42; }, 20s));
  const BusTime begun = rig.now;
  ASSERT_TRUE(rig.run_until([&] { return rig.joints()[0] > 58; }, 20s));
  EXPECT_NEAR(to_seconds(rig.now - begun), 1.6, 0.02);
}

TEST_F(FeedPerTurn, AnOverrideCountsOnTop) {
  ASSERT_TRUE(begin("M3 S600\nG0 X0\nG95 G1 X40 F0.5\n"));
  ASSERT_TRUE(rig.run_until([&] { return rig.joints()[0] > 4; }, 20s));
  ASSERT_TRUE(rig.gateway->carry_out(command::SetFeedOverride{0.5}));
  const Cut cut = cut_between(8, 38);
  EXPECT_NEAR(cut.mm / cut.turns, 0.25, 0.002);
}

TEST_F(Threads, ASurfaceSpeedKeepsWithinItsLimit) {
  // 100 m/min are 796 rpm at X20, 1592 at X10, and more than the spindle can at X1.
  ASSERT_TRUE(begin("G0 X20\nG96 S100 D2500 M3\nG0 X10\nG4 P0.1\nG0 X1\nG4 P0.1\nG96 S100 D800\nG4 P0.1\n"));
  std::vector<double> told;
  ASSERT_TRUE(rig.run_until(
      [&] {
        const double rpm = rig.gateway->status().spindle.target_rpm;
        if (told.empty() || told.back() != rpm) told.push_back(rpm);
        return rig.gateway->state() == MachineState::kReady;
      },
      60s))
      << rig.story();
  ASSERT_GE(told.size(), 5U);
  EXPECT_NEAR(told[1], 795.8, 0.1);
  EXPECT_NEAR(told[2], 1591.5, 0.1);
  EXPECT_EQ(told[3], 2500);
  EXPECT_EQ(told[4], 800);
}

}  // namespace
}  // namespace kinebus
