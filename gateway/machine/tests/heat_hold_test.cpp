// A heater's fault in a print: held on the path, lifted, gone on with; measured at the motors and at the
// node.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/machine/tests/heat_printer.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kBesideIt = 5e-3;  // mm: on the way up and down
constexpr double kLift = 5;         // mm

const std::string kLine = "M104 S80\nM109 S80\nG1 X60 F600\nG1 X-60\n";

class HeldByHeat : public HeatPrinter {
 protected:
  double off_the_line() {
    const Pose pose = tool();
    return std::max(std::abs(pose[kY] - line[kY]), std::abs(pose[kZ] - line[kZ]));
  }
  /// In the middle of kLine.
  ::testing::AssertionResult prints(const std::string& job = kLine) {
    if (!begin(job) || !rig.run_until([&] { return rig.gateway->status().pose[kX] > 20; }, 900s))
      return ::testing::AssertionFailure() << rig.story();
    line = tool();
    return ::testing::AssertionSuccess();
  }
  void lift_by(double mm) {
    rig.machine.thermal.lift_mm = mm;
    rig.gateway = std::make_unique<Gateway>(rig.machine);
  }
  ::testing::AssertionResult held() {
    if (!rig.reach(MachineState::kHeld, 10s)) return ::testing::AssertionFailure() << rig.story();
    return ::testing::AssertionSuccess();
  }
  ::testing::AssertionResult opens() {
    breaks("sensor 1 open");
    return held();
  }
  void mend() {
    breaks("sensor 1 ok");
    rig.run_for(1s);
  }
  /// Heats, comes back from above, and is on the line to its end.
  ::testing::AssertionResult goes_on_to_the_end() {
    const auto failure = [&] { return ::testing::AssertionFailure() << rig.story(); };
    rig.events.clear();
    if (!rig.gateway->carry_out(command::Resume{})) return failure() << "resume is refused";
    const Pose from = tool();
    double sideways = 0, below = 0;
    if (!rig.run_until(
            [&] {
              const Pose pose = tool();
              below = std::max(below, line[kZ] - pose[kZ]);
              sideways = std::max({sideways, std::abs(pose[kX] - from[kX]), std::abs(pose[kY] - from[kY])});
              return rig.story().find("the job part goes on") != std::string::npos;
            },
            900s))
      return failure() << "it does not go on";
    if (below > kOnTheLine || sideways > kBesideIt) return failure() << sideways << " mm off, " << below;
    if (off_the_line() > kOnTheLine) return failure() << off_the_line() << " mm off when it goes on";
    if (hotend() < 76) return failure() << "it goes on at " << hotend();
    double off = 0;
    if (!rig.run_until(
            [&] {
              off = std::max(off, off_the_line());
              return rig.gateway->state() == MachineState::kReady;
            },
            120s))
      return failure() << "the job does not end";
    if (off > kOnTheLine) return failure() << off << " mm off the line";
    if (std::abs(tool()[kX] + 60) > kOnTheLine) return failure() << tool()[kX];
    return ::testing::AssertionSuccess();
  }

  Pose line{};
};

TEST_F(HeldByHeat, AnOpenSensorHoldsTheJobOnThePathAndLiftsTheTool) {
  ASSERT_TRUE(prints("M140 S40\nM190 S40\n" + kLine));
  ASSERT_EQ(breaks("sensor 1 open"), "");
  const BusTime opened = rig.now;
  BusTime off{0};
  double off_line = 0, risen = 0, last_x = tool()[kX], x_at_rest = 0;
  ASSERT_TRUE(rig.run_until(
      [&] {
        const Pose pose = tool();
        if (power(0) == 0 && off == BusTime{0}) off = rig.now;
        // On the line as long as it goes along it, and straight up from there.
        off_line = std::max(off_line, std::abs(pose[kY] - line[kY]));
        if (pose[kX] - last_x > 1e-4) off_line = std::max(off_line, std::abs(pose[kZ] - line[kZ]));
        if (risen == 0) x_at_rest = pose[kX];
        risen = pose[kZ] - line[kZ] > 0.01 ? pose[kZ] - line[kZ] : risen;
        last_x = std::max(last_x, pose[kX]);
        return rig.gateway->state() == MachineState::kHeld;
      },
      10s))
      << rig.story();
  EXPECT_GT(off, opened);
  EXPECT_LE(off - opened, 500ms);
  EXPECT_LT(off_line, kOnTheLine);
  EXPECT_NEAR(tool()[kZ], line[kZ] + kLift, kOnTheLine);
  EXPECT_NEAR(tool()[kX], x_at_rest, kBesideIt);
  const MachineStatus s = rig.gateway->status();
  EXPECT_TRUE(rig.told(AlarmCode::kThermal));
  EXPECT_EQ(s.doing.english(), "heater.hotend: a temperature sensor or its wire is open");
  EXPECT_TRUE(s.positions_known);
  EXPECT_EQ(s.job, "part");
  EXPECT_EQ(s.heater(kFirstHotend).target_celsius, 0);
  EXPECT_EQ(s.heater(kFirstBed).target_celsius, 40) << "the part stays where it is";
  for (std::size_t n = 0; n < 3; ++n) EXPECT_EQ(s.nodes[n].statusword[0] & 0x6F, 0x27) << "drives hold";
  rig.run_for(30s);

  // Not mended: said again, and nothing moves.
  rig.events.clear();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  rig.run_for(5s);
  EXPECT_TRUE(rig.told(AlarmCode::kThermal)) << rig.story();
  EXPECT_EQ(rig.gateway->state(), MachineState::kHeld);
  EXPECT_NEAR(tool()[kZ], line[kZ] + kLift, kOnTheLine);

  mend();
  EXPECT_TRUE(goes_on_to_the_end());
}

TEST_F(HeldByHeat, MoreFaultsWhileItIsHeldTakeTheirHeatAndNothingMoves) {
  ASSERT_TRUE(prints("M140 S40\n" + kLine));
  ASSERT_TRUE(opens());
  rig.run_for(2s);
  ASSERT_EQ(breaks("sensor 2 short"), "");
  rig.run_for(2s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kHeld);
  EXPECT_EQ(rig.gateway->status().heater(kFirstBed).target_celsius, 0);
  EXPECT_EQ(power(1), 0);
  EXPECT_NE(rig.story().find("heater.bed: "), std::string::npos) << rig.story();
  EXPECT_NEAR(tool()[kZ], line[kZ] + kLift, kOnTheLine);

  // One of two is mended: not yet.
  mend();
  rig.events.clear();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  rig.run_for(5s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kHeld);
  EXPECT_TRUE(rig.told(AlarmCode::kThermal)) << rig.story();

  // On the way back it opens again: held once more, no higher than before.
  breaks("sensor 2 ok");
  rig.run_for(1s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 10s)) << rig.story();
  rig.run_for(3s);
  ASSERT_TRUE(opens());
  EXPECT_NEAR(tool()[kZ], line[kZ] + kLift, kOnTheLine);
  mend();
  EXPECT_TRUE(goes_on_to_the_end());
  EXPECT_EQ(rig.gateway->status().heater(kFirstBed).target_celsius, 40);
}

TEST_F(HeldByHeat, CancelInItGivesTheJobUpAndTheNextOneRunsWhenItIsMended) {
  ASSERT_TRUE(prints());
  ASSERT_TRUE(opens());
  mend();
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s)) << rig.story();
  EXPECT_FALSE(rig.gateway->status().interrupted);
  EXPECT_NEAR(tool()[kZ], line[kZ] + kLift, kOnTheLine);
  rig.run_for(3s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kReady) << rig.story();
  ASSERT_TRUE(rig.run_job("M109 S60\nG1 X0 F3000\n", 300s)) << rig.story();
  EXPECT_NEAR(tool()[kX], 0, kOnTheLine);
  EXPECT_GT(hotend(), 56);
}

TEST_F(HeldByHeat, CancelWhileItIsLiftedLeavesARestThatIsKnown) {
  lift_by(100);
  ASSERT_TRUE(prints());
  ASSERT_EQ(breaks("sensor 1 open"), "");
  ASSERT_TRUE(rig.run_until([&] { return tool()[kZ] > line[kZ] + 1; }, 10s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->state() != MachineState::kCancelling; }, 5s));
  EXPECT_LT(tool()[kZ], line[kZ] + 99);
  EXPECT_FALSE(rig.gateway->status().interrupted);
  EXPECT_NEAR(rig.gateway->status().machine_pose[kZ], tool()[kZ], kOnTheLine);
  EXPECT_NEAR(rig.gateway->status().machine_pose[kX], tool()[kX], kOnTheLine);
  // The sensor is still open: that is an alarm, now that no job is held by it.
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 10s)) << rig.story();
}

TEST_F(HeldByHeat, AStopWhileItIsLiftedAndOneWhileItIsHeldLeaveTheJobToResume) {
  lift_by(100);
  ASSERT_TRUE(prints());
  ASSERT_EQ(breaks("sensor 1 open"), "");
  ASSERT_TRUE(rig.run_until([&] { return tool()[kZ] > line[kZ] + 1; }, 10s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << rig.story();
  EXPECT_LT(tool()[kZ], line[kZ] + 90);
  mend();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(held());
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(held());
  EXPECT_TRUE(goes_on_to_the_end());
}

TEST_F(HeldByHeat, TheEmergencyStopInputInItTakesAllHeatAndTheJobCanGoOnLater) {
  ASSERT_TRUE(prints("M140 S40\n" + kLine));
  ASSERT_TRUE(opens());
  rig.nodes.set_input(2, rig.now, 7, true);
  rig.run_for(200ms);
  EXPECT_EQ(power(0) + power(1), 0);
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << rig.story();
  EXPECT_EQ(rig.gateway->status().heater(kFirstBed).target_celsius, 0);
  rig.nodes.set_input(2, rig.now, 7, false);
  mend();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(held());
  EXPECT_TRUE(goes_on_to_the_end());
  EXPECT_EQ(rig.gateway->status().heater(kFirstBed).target_celsius, 40);
}

TEST_F(HeldByHeat, AHeatNodeThatDiesMeanwhileIsNamedAndTheJobGoesOnWhenItIsBack) {
  ASSERT_TRUE(prints());
  ASSERT_TRUE(opens());
  rig.nodes.set_power(kHeat, rig.now, false);
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 5s)) << rig.story();
  EXPECT_NE(rig.story().find("node 20 is silent"), std::string::npos) << rig.story();
  EXPECT_TRUE(rig.gateway->status().positions_known);
  EXPECT_NEAR(tool()[kZ], line[kZ] + kLift, kOnTheLine);
  breaks("sensor 1 ok");
  rig.nodes.set_power(kHeat, rig.now, true);
  rig.run_for(2s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  EXPECT_TRUE(goes_on_to_the_end());
}

TEST_F(HeldByHeat, AFaultWhileTheJobWaitsForHeatIsHeldToo) {
  ASSERT_TRUE(begin(kLine)) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return hotend() > 40; }, 200s)) << rig.story();
  line = tool();
  ASSERT_TRUE(opens());
  mend();
  EXPECT_TRUE(goes_on_to_the_end());
}

TEST_F(HeldByHeat, WhatIsHeldByHandIsLiftedToo) {
  ASSERT_TRUE(prints());
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(held());
  rig.run_for(1s);
  ASSERT_EQ(breaks("sensor 1 open"), "");
  ASSERT_TRUE(rig.reach(MachineState::kHolding, 2s)) << rig.story();
  ASSERT_TRUE(held());
  EXPECT_NEAR(tool()[kZ], line[kZ] + kLift, kOnTheLine);
  mend();
  EXPECT_TRUE(goes_on_to_the_end());
}

TEST_F(HeldByHeat, AHoldOnTheWayBackGoesOnWithIt) {
  ASSERT_TRUE(prints());
  ASSERT_TRUE(opens());
  mend();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return tool()[kZ] < line[kZ] + kLift - 1; }, 200s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(held());
  EXPECT_GT(tool()[kZ], line[kZ] + 0.1);
  EXPECT_TRUE(goes_on_to_the_end());
}

TEST_F(HeldByHeat, AStopOnTheWayBackLeavesTheJobToResume) {
  ASSERT_TRUE(prints());
  ASSERT_TRUE(opens());
  mend();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until([&] { return tool()[kZ] < line[kZ] + kLift - 1; }, 200s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(held());
  EXPECT_TRUE(goes_on_to_the_end());
}

TEST_F(HeldByHeat, WhatTheJobSaysWhileItComesToRestIsSaidWhenItGoesOn) {
  // The target changes within the way that the stop takes.
  std::string job = "M109 S80\nG1 X20 F6000\n";
  for (int x = 21; x < 60; ++x)
    job += "M104 S" + std::to_string(60 + x) + "\nG1 X" + std::to_string(x) + "\n";
  ASSERT_TRUE(begin(job + "G1 X-60 F6000\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->status().pose[kX] > 30; }, 900s)) << rig.story();
  line = tool();
  ASSERT_TRUE(opens());
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 0);
  mend();
  EXPECT_TRUE(goes_on_to_the_end());
  EXPECT_EQ(rig.gateway->status().heater(kFirstHotend).target_celsius, 119);
}

TEST_F(HeldByHeat, TheToolRisesNoFartherThanItMay) {
  lift_by(1000);
  ASSERT_TRUE(prints());
  ASSERT_TRUE(opens());
  EXPECT_NE(rig.story().find("the tool is not lifted as far as it should be: "), std::string::npos)
      << rig.story();
  Pose above = tool();
  EXPECT_GT(above[kZ], line[kZ] + 100);
  EXPECT_TRUE(kinematics->check(Frame::kMachine, above));
  above[kZ] += 1;
  EXPECT_FALSE(kinematics->check(Frame::kMachine, above));
  mend();
  EXPECT_TRUE(goes_on_to_the_end());
}

}  // namespace
}  // namespace kinebus
