// Moves by hand as a person makes them: click after click, and a key held.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/machine/tests/machine_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class Jogs : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(rig.make_ready()) << rig.story(); }
  Result<void, Refusal> jog(const Pose& delta, double speed = 50, bool held = false) {
    return rig.gateway->carry_out(command::Jog{delta, speed, held});
  }
  /// Gives the held command again every 50 ms for `duration`.
  void hold(const Pose& delta, BusTime duration, double speed = 50) {
    for (const BusTime until = rig.now + duration; rig.now < until; rig.run_for(50ms)) {
      const auto done = jog(delta, speed, true);
      ASSERT_TRUE(done) << done.error().words;
    }
  }
  double at(PoseAxis axis) { return rig.gateway->status().machine_pose[axis]; }

  MachineRig rig;
};

TEST_F(Jogs, FiveClicksAreFiveSteps) {
  const double before = at(kX);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(jog({1, 0, 0, 0, 0, 0}));
    rig.run_for(10ms);
    EXPECT_EQ(rig.gateway->state(), MachineState::kMoving);
  }
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  EXPECT_NEAR(at(kX), before + 5, 2e-3);
  EXPECT_EQ(std::count_if(rig.events.begin(), rig.events.end(),
                          [](const MachineEvent& e) { return e.words == "move done"; }),
            2)
      << "the bed reference, and all clicks together";
}

TEST_F(Jogs, ThatGoElsewhereAreCarriedOutOneAfterTheOther) {
  double farthest = at(kX);
  const double x = at(kX), y = at(kY);
  for (const Pose& delta : {Pose{4, 0, 0, 0, 0, 0}, Pose{0, 3, 0, 0, 0, 0}, Pose{-4, 0, 0, 0, 0, 0}})
    ASSERT_TRUE(jog(delta));
  ASSERT_TRUE(rig.run_until(
      [&] {
        farthest = std::max(farthest, at(kX));
        return rig.gateway->state() == MachineState::kReady;
      },
      10s));
  EXPECT_NEAR(farthest, x + 4, 2e-2);
  EXPECT_NEAR(at(kX), x, 2e-3);
  EXPECT_NEAR(at(kY), y + 3, 2e-3);
}

TEST_F(Jogs, ThatWouldLeaveTheWorkspaceTogetherAreRefusedWhenTheyAreAsked) {
  int taken = 0;
  while (taken < 100 && jog({10, 0, 0, 0, 0, 0})) ++taken;
  EXPECT_GT(taken, 2);
  EXPECT_LT(taken, 100);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s));
  EXPECT_NEAR(at(kX), 10 * taken, 5e-3);
}

TEST_F(Jogs, CancelDropsThoseThatWait) {
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(jog({10, 0, 0, 0, 0, 0}));
  rig.run_for(100ms);
  ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  const double x = at(kX);
  EXPECT_LT(x, 15);
  rig.run_for(1s);
  EXPECT_NEAR(at(kX), x, 1e-6);
}

TEST_F(Jogs, FollowNoOtherMove) {
  ASSERT_TRUE(jog({20, 0, 0, 0, 0, 0}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  ASSERT_TRUE(rig.gateway->carry_out(command::GoToReference{}));
  rig.run_for(50ms);
  EXPECT_FALSE(rig.gateway->may(command::kind<command::Jog>));
  EXPECT_FALSE(jog({1, 0, 0, 0, 0, 0}));
}

TEST_F(Jogs, AHeldOneRunsUntilItIsLetGo) {
  const double x = at(kX);
  hold({1000, 0, 0, 0, 0, 0}, 1s);
  const double released = at(kX);
  EXPECT_LT(released - x, 50);
  EXPECT_GT(released - x, 50 * 0.75) << "but for the time until it begins";
  ASSERT_TRUE(jog({}, 50, true));
  const BusTime began = rig.now;
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  EXPECT_LT(to_seconds(rig.now - began), 1);
  // The ramp of a hold: half of its time at full speed, and what the nodes have in hand.
  EXPECT_LT(at(kX) - released, 50 * (to_seconds(BusTime{rig.machine.stop.hold_ramp}) / 2 + 0.03));
  EXPECT_TRUE(jog({-5, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(rig.reach(MachineState::kReady, 10s));
}

TEST_F(Jogs, AHeldOneEndsWhenNobodySpeaksAnyMore) {
  hold({1000, 0, 0, 0, 0, 0}, 300ms);
  const BusTime last = rig.now - 50ms;
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->state() != MachineState::kMoving; }, 1s));
  EXPECT_LT(to_seconds(rig.now - last), 0.22);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  EXPECT_LT(at(kX), 50 * 0.7);
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

TEST_F(Jogs, AHeldOneEndsBeforeTheWorkspaceDoes) {
  for (int i = 0; i < 400 && jog({1000, 0, 0, 0, 0, 0}, 100, true); ++i) rig.run_for(50ms);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  const auto beyond = jog({1000, 0, 0, 0, 0, 0}, 100, true);
  ASSERT_FALSE(beyond);
  EXPECT_GT(at(kX), 50);
  // Nor can a step of 1 mm.
  EXPECT_FALSE(jog({2, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(rig.told(MachineEvent::Kind::kAlarm)) << rig.story();
}

TEST_F(Jogs, AHeldOneTakesNoOtherDirectionAndNoStep) {
  hold({1000, 0, 0, 0, 0, 0}, 100ms);
  EXPECT_FALSE(jog({0, 1000, 0, 0, 0, 0}, 50, true));
  EXPECT_FALSE(jog({1, 0, 0, 0, 0, 0}));
  ASSERT_TRUE(jog({}, 50, true));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  EXPECT_TRUE(jog({}, 50, true)) << "let go twice";
  EXPECT_EQ(rig.gateway->state(), MachineState::kReady);
}

TEST_F(Jogs, InAnInterruptedJobLeaveItThere) {
  ASSERT_TRUE(
      rig.gateway->carry_out(command::Run{std::make_unique<StringSource>("G1 X60 F1200\nG1 X0\n"), "test"}));
  ASSERT_TRUE(rig.run_until([&] { return at(kX) > 20; }, 60s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 10s));
  ASSERT_TRUE(rig.gateway->carry_out(command::MotorsOff{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  hold({0, 0, -1000, 0, 0, 0}, 300ms);
  ASSERT_TRUE(jog({}, 50, true));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 10s));
  ASSERT_TRUE(rig.gateway->may(command::kind<command::Resume>)) << rig.story();
}

}  // namespace
}  // namespace kinebus
