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

}  // namespace
}  // namespace kinebus
