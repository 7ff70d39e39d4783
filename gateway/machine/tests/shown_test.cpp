// What of the machine is shown, and what its devices are told meanwhile.

#include <gtest/gtest.h>

#include <string>

#include "gateway/machine/tests/hand_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class Shown : public HandRig {};

TEST_F(Shown, TheToolIsShownWhereItIs) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to(kLine, 20));
  for (int i = 0; i < 5; ++i) {
    rig.run_for(100ms);
    const JointVector true_joints = rig.joints();
    for (std::size_t joint = 0; joint < 4; ++joint)
      EXPECT_NEAR(status().joints[joint], true_joints[joint], 0.05) << joint;
  }
  EXPECT_EQ(status().rate, 1);
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  const JointVector true_joints = rig.joints();
  for (std::size_t joint = 0; joint < 4; ++joint)
    EXPECT_NEAR(status().joints[joint], true_joints[joint], 2e-3) << joint;
}

TEST_F(Shown, ItsPlaceInTheJobAndWhatIsLeftAtThePresentOverride) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(runs_to("M104 S200\nG1 X60 E6 F1200\nG1 X0 E3\n", 30));
  MachineStatus s = status();
  EXPECT_EQ(s.line, 2U);
  EXPECT_NEAR(s.progress, 0.25, 0.02);
  EXPECT_NEAR(s.remaining_s, 4.5, 0.2);
  ASSERT_TRUE(s.job_filament_mm);
  EXPECT_NEAR(*s.job_filament_mm, 3, 0.1);
  EXPECT_FALSE(s.interrupted);
  const double elapsed = s.elapsed_s;
  ASSERT_TRUE(asks(command::SetFeedOverride{0.5}));
  rig.run_for(1s);
  s = status();
  EXPECT_EQ(s.feed_override, 0.5);
  EXPECT_NEAR(s.elapsed_s, elapsed + 1, 1e-6);
  EXPECT_NEAR(s.remaining_s, (1 - s.progress) * 6 / 0.5, 0.3);
  EXPECT_NEAR(s.rate, 0.5, 1e-3);
  ASSERT_TRUE(rig.run_until([&] { return status().line == 3; }, 30s));
  EXPECT_GT(status().progress, 0.49);
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  s = status();
  EXPECT_EQ(s.progress, 0);
  EXPECT_EQ(s.remaining_s, 0);
  EXPECT_EQ(s.line, 0U);
  EXPECT_EQ(s.elapsed_s, 0);
  EXPECT_FALSE(s.job_filament_mm);
}

TEST_F(Shown, AMoveHasItsTimeAndTheWayToAJobNone) {
  ASSERT_TRUE(ready());
  ASSERT_TRUE(asks(command::Jog{.delta = {30, 0, 0, 0, 0, 0}, .speed_per_s = 30}));
  rig.run_for(400ms);
  EXPECT_NEAR(status().elapsed_s, 0.4, 0.01);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  EXPECT_EQ(status().elapsed_s, 0);
  ASSERT_TRUE(runs("G1 X-20 F1200\n"));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 2s));
  rig.run_for(50ms);
  EXPECT_EQ(status().elapsed_s, 0);
  EXPECT_EQ(status().line, 0U);
}

TEST_F(Shown, WhatItDoesIsSaidByWhoDoesIt) {
  const auto doing = [&] { return status().doing.english(); };
  EXPECT_EQ(doing(), "off");
  ASSERT_TRUE(asks(command::BringUp{}));
  rig.run_for(10ms);
  const std::string listens = doing();
  EXPECT_NE(listens, "bring-up");
  bool read = false;
  ASSERT_TRUE(rig.run_until(
      [&] {
        read = read || doing() == "reading where the nodes stand";
        return state() == MachineState::kUnhomed;
      },
      30s));
  EXPECT_TRUE(read);
  EXPECT_EQ(doing(), "not homed");
  ASSERT_TRUE(ready() || asks(command::Home{}));
}

TEST_F(Shown, CurrentsAreThoseThatTheFileGivesAJointsOwnAxis) {
  ASSERT_TRUE(ready());
  const MachineStatus s = status();
  for (const JointDescription& joint : rig.machine.joints)
    for (const NodeStatus& node : s.nodes) {
      if (node.id != joint.node_id) continue;
      EXPECT_NEAR(node.run_current_a[joint.axis], joint.run_current_ma * 1e-3, 1e-9);
      EXPECT_NEAR(node.hold_current_a[joint.axis], joint.hold_current_ma * 1e-3, 1e-9);
      EXPECT_FALSE(node.measures[joint.axis]);
    }
}

TEST_F(Shown, TheExtruderIsFollowedTenTimesASecondWhereItIsKnown) {
  ASSERT_TRUE(asks(command::BringUp{}));
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s));
  EXPECT_EQ(hand.followed, 0);
  EXPECT_GT(hand.hotend.fed_ahead, 0);
  ASSERT_TRUE(asks(command::Home{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 120s));
  ASSERT_TRUE(runs_to("M104 S200\nG1 X60 E6 F1200\nG1 X0\n", 20));
  const int followed = hand.followed, fed = hand.hotend.fed_ahead;
  rig.run_for(1s);
  EXPECT_NEAR(hand.followed - followed, 10, 1);
  EXPECT_NEAR(hand.hotend.fed_ahead - fed, 10, 1);
  EXPECT_NEAR(hand.extruder_mm, status().machine_pose[kE], 0.3);
  EXPECT_GT(hand.hotend.ahead[0], 0);
  ASSERT_TRUE(rig.reach(MachineState::kReady));
  rig.run_for(200ms);
  EXPECT_EQ(hand.hotend.ahead[0], 0);
}

TEST_F(Shown, APinThatIsMovedByHandIsToldOfWhenItIsThere) {
  using Pin = ContactProbe::Pin;
  EXPECT_NE(why_not(command::MovePin{ContactProbe::PinOrder::kOut}), "");
  hand.pin = Pin::kIn;
  use(rig.machine);
  ASSERT_TRUE(ready());
  const auto comes_to = [&](Pin pin) {
    hand.pin = pin;
    rig.run_for(200ms);
    return told();
  };
  EXPECT_EQ(comes_to(Pin::kOut), "") << "nobody has moved it";
  EXPECT_EQ(comes_to(Pin::kIn), "");
  ASSERT_TRUE(asks(command::MovePin{ContactProbe::PinOrder::kOut}));
  EXPECT_EQ(hand.pin_order, ContactProbe::PinOrder::kOut);
  EXPECT_EQ(comes_to(Pin::kMoves), "");
  EXPECT_EQ(comes_to(Pin::kOut), "- the probe's pin is out\n");
  EXPECT_EQ(comes_to(Pin::kMoves), "");
  EXPECT_EQ(comes_to(Pin::kIn), "") << "once";
  ASSERT_TRUE(asks(command::MovePin{ContactProbe::PinOrder::kIn}));
  EXPECT_EQ(comes_to(Pin::kMoves), "");
  EXPECT_EQ(comes_to(Pin::kIn), "- the probe's pin is in\n");
  EXPECT_EQ(comes_to(Pin::kFailed), "- the pin is stuck\n") << "whoever moved it";
  EXPECT_EQ(comes_to(Pin::kFailed), "");
  EXPECT_EQ(comes_to(Pin::kIn), "");
  ASSERT_TRUE(runs_to(kLine, 5));
  told();
  EXPECT_EQ(comes_to(Pin::kFailed), "") << "a job looks at it itself";
}

}  // namespace
}  // namespace kinebus
