// A mill's spindle from the gateway's side.

#include <gtest/gtest.h>

#include <cmath>

#include "gateway/machine/tests/machine_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

MachineDescription mill() {
  MachineDescription machine = default_m1();
  machine.heaters.clear();
  machine.fans.clear();
  machine.spindle = {.present = true, .min_rpm = 3000, .max_rpm = 24000, .sim_rpm_per_s = 6000};
  return machine;
}

bool run(MachineRig& rig, const std::string& text) {
  return rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(text), "part"}).has_value();
}

TEST(Spindle, TheToolFeedsOnlyWhenItTurnsAndItStopsWithTheJob) {
  MachineRig rig(mill());
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  const double x = rig.gateway->status().pose[kX];
  ASSERT_TRUE(run(rig, "M3 S12000\nG1 X20 F1200\nG1 X0\n"));
  ASSERT_TRUE(rig.run_until([&] { return std::abs(rig.gateway->status().pose[kX] - x) > 0.01; }, 30s));
  EXPECT_NEAR(rig.gateway->status().spindle.actual_rpm, 12000, 240);
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  EXPECT_EQ(rig.gateway->status().spindle.target_rpm, 0);
}

TEST(Spindle, AStopStopsItAndTheJobGoesOnOnlyWhenItTurnsAgain) {
  MachineRig rig(mill());
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(run(rig, "M3 S9000\nG1 X40 F600\nG1 X-40\n"));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] > 20; }, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  EXPECT_EQ(rig.gateway->status().spindle.target_rpm, 0);
  ASSERT_TRUE(rig.reach(MachineState::kStopped)) << rig.story();
  rig.run_for(3s);
  EXPECT_EQ(rig.gateway->status().spindle.actual_rpm, 0);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld)) << rig.story();
  const double x = rig.gateway->status().pose[kX];
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return std::abs(rig.gateway->status().pose[kX] - x) > 0.05; }, 60s))
      << rig.story();
  EXPECT_NEAR(rig.gateway->status().spindle.actual_rpm, 9000, 180);
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  EXPECT_NEAR(rig.gateway->status().pose[kX], -40, 2e-3);
}

TEST(Spindle, AFeedHoldLeavesItTurning) {
  MachineRig rig(mill());
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(run(rig, "M3 S9000\nG1 X40 F600\n"));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] > 10; }, 30s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld)) << rig.story();
  EXPECT_NEAR(rig.gateway->status().spindle.actual_rpm, 9000, 180);
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  EXPECT_EQ(rig.gateway->status().spindle.target_rpm, 0) << "a job that is given up needs no cutter";
}

TEST(Spindle, SpeedsItCannotTurnAreRefusedBeforeAnythingMoves) {
  for (const auto& [text, words] : {std::pair{"M3 S30000\nG1 X1 F600\n", "allowed are 3000 to 24000 rpm"},
                                    std::pair{"M4 S9000\nG1 X1 F600\n", "one way only"}}) {
    MachineRig rig(mill());
    ASSERT_TRUE(rig.make_ready()) << rig.story();
    ASSERT_TRUE(run(rig, text));
    ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
    EXPECT_NE(rig.story().find(words), std::string::npos) << rig.story();
    EXPECT_EQ(rig.gateway->status().spindle.actual_rpm, 0);
  }
}

TEST(Spindle, AMachineWithoutOneRefusesIt) {
  MachineRig rig;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(run(rig, "M3 S9000\n"));
  ASSERT_TRUE(rig.reach(MachineState::kReady)) << rig.story();
  EXPECT_NE(rig.story().find("which this machine does not have"), std::string::npos) << rig.story();
}

}  // namespace
}  // namespace kinebus
