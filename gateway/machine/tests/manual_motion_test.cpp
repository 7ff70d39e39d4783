// Which moves by hand are begun, how far and how fast; which follow one another; and how far up is free.

#include "gateway/machine/manual_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <variant>

#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class ManualMotionTest : public ::testing::Test {
 protected:
  static constexpr Pose kHere{10, -5, 40, 0.1, 0.2, 7};

  std::string refusal(const command::Jog& asked, const Pose& from = kHere) {
    const auto move = hand->jog(asked, from, *heat);
    return move ? "" : move.error().words.english();
  }
  canonical::Feed move(const command::Jog& asked, const Pose& from = kHere) {
    const auto made = hand->jog(asked, from, *heat);
    EXPECT_TRUE(made) << made.error().words;
    return made ? *made : canonical::Feed{};
  }
  static command::Jog along(PoseAxis axis, double by, double speed = 0, bool held = false) {
    command::Jog jog{.delta = {}, .speed_per_s = speed, .while_held = held};
    jog.delta[axis] = by;
    return jog;
  }
  /// One is under way, from here along X.
  void begin(const command::Jog& asked) { hand->begin_jog(1s, asked, move(asked), kHere); }
  void rebuild() {
    heat = std::make_unique<Heat>(machine, devices);
    hand = std::make_unique<ManualMotion>(machine, *kinematics, group, rate, *heat, events, journal, nullptr);
  }
  void without_heaters() {
    machine.heaters.clear();
    rebuild();
  }
  /// The highest place over the table's middle, to 10 um.
  Pose top() {
    Pose pose = kinematics->bed_reference();
    for (const double step : {10., 1., 0.1, 0.01}) {
      while (kinematics->check(Frame::kMachine, pose)) pose[kZ] += step;
      pose[kZ] -= step;
    }
    return pose;
  }

  MachineDescription machine = default_m1();
  std::unique_ptr<Kinematics> kinematics = std::move(*make_kinematics(machine));
  std::vector<NodeAxes> axes = node_axes(machine);
  StreamGroup group{*kinematics, axes, stream_options(machine)};
  PathRate rate;
  Devices devices;
  EventQueue events;
  journal::Queue journal;
  std::unique_ptr<Heat> heat = std::make_unique<Heat>(machine, devices);
  std::unique_ptr<ManualMotion> hand =
      std::make_unique<ManualMotion>(machine, *kinematics, group, rate, *heat, events, journal, nullptr);
};

TEST_F(ManualMotionTest, AJogEndsWhereItIsAskedToAtTheSpeedThatIsAsked) {
  without_heaters();
  const double steps[kPoseAxes] = {3, -4, 2.5, 0.03, -0.02, 1.5};
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis) {
    const canonical::Feed feed = move(along(static_cast<PoseAxis>(axis), steps[axis], 12.5));
    EXPECT_EQ(feed.frame, Frame::kMachine);
    EXPECT_EQ(feed.feed_per_s, 12.5);
    for (std::size_t other = 0; other < kPoseAxes; ++other)
      EXPECT_NEAR(feed.target[other], kHere[other] + (other == axis ? steps[axis] : 0), 1e-12) << axis;
  }
  const Pose by{1, 2, 3, 0.01, 0.02, 4};
  const canonical::Feed all = move({.delta = by});
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis)
    EXPECT_NEAR(all.target[axis], kHere[axis] + by[axis], 1e-12);
}

TEST_F(ManualMotionTest, ASpeedThatIsNotAskedIsThatOfWhatMoves) {
  without_heaters();
  EXPECT_EQ(move(along(kX, 1)).feed_per_s, 20);
  EXPECT_EQ(move(along(kY, 1)).feed_per_s, 20);
  EXPECT_EQ(move(along(kZ, 1)).feed_per_s, 20);
  EXPECT_EQ(move(along(kA, 0.01)).feed_per_s, 0.3);
  EXPECT_EQ(move(along(kC, -0.01)).feed_per_s, 0.3);
  EXPECT_EQ(move(along(kE, -1)).feed_per_s, 3);
  EXPECT_EQ(move({.delta = {1, 0, 0, 0.01, 0, 0}}).feed_per_s, 20);
}

TEST_F(ManualMotionTest, WhatIsNoNumberIsRefused) {
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis)
    for (const double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL})
      EXPECT_EQ(refusal(along(static_cast<PoseAxis>(axis), wrong)), "a jog needs numbers");
  for (const double wrong : {std::nan(""), HUGE_VAL, -1.})
    EXPECT_EQ(refusal(along(kX, 1, wrong)), "a jog's speed is 0 or more");
  EXPECT_EQ(refusal({}), "a jog needs a distance");
}

TEST_F(ManualMotionTest, ColdFilamentIsDrawnBackAndNotFed) {
  EXPECT_EQ(refusal(along(kE, 1)).find("the hotend is too cold to feed filament"), 0U);
  EXPECT_EQ(refusal(along(kE, -1)), "");
  EXPECT_EQ(refusal(along(kX, 1)), "");
  without_heaters();
  EXPECT_EQ(refusal(along(kE, 1)), "") << "nothing has to melt";
}

TEST_F(ManualMotionTest, OneThatIsHeldEndsAtTheLastPlaceThatIsAllowedAndAStepIsRefused) {
  const std::string beyond = refusal(along(kX, 500));
  EXPECT_NE(beyond.find("X is "), std::string::npos) << "by how far its end is outside: " << beyond;
  EXPECT_NE(beyond.find(" outside the workspace"), std::string::npos) << beyond;
  EXPECT_EQ(beyond.find("go to the bed reference"), std::string::npos) << "it stands well";
  const Pose end = move(along(kX, 500, 0, true)).target;
  EXPECT_TRUE(kinematics->check(Frame::kMachine, end));
  Pose farther = end;
  farther[kX] += 1.01;
  EXPECT_FALSE(kinematics->check(Frame::kMachine, farther)) << "to a millimetre";
  EXPECT_NEAR(end[kY], kHere[kY], 1e-12);
  EXPECT_NE(refusal(along(kX, 500, 0, true), end), "") << "no way is left";
  const Pose turned = move(along(kA, 3, 0, true)).target;
  farther = turned;
  farther[kA] += 0.0101;
  EXPECT_TRUE(kinematics->check(Frame::kMachine, turned));
  EXPECT_FALSE(kinematics->check(Frame::kMachine, farther)) << "to a hundredth of a radian";
}

TEST_F(ManualMotionTest, FromOutsideTheWorkspaceTheWayOutIsNamed) {
  Pose outside = kHere;
  outside[kX] = 300;
  const std::string words = refusal(along(kX, 1), outside);
  EXPECT_NE(words.find("outside the workspace: go to the bed reference first"), std::string::npos) << words;
  EXPECT_EQ(refusal(along(kE, -1), outside), "") << "filament moves wherever the tool stands";
}

TEST_F(ManualMotionTest, JogsWaitInTheirOrderAndThoseThatGoOnAlikeAreOne) {
  begin(along(kX, 5, 10));
  EXPECT_EQ(hand->jogs(), ManualMotion::Jogs::kBySteps);
  EXPECT_FALSE(hand->take_jog());
  const auto add = [&](const command::Jog& asked) { return hand->add_jog(asked, *heat).has_value(); };
  ASSERT_TRUE(add(along(kX, 1, 10)));
  ASSERT_TRUE(add(along(kX, 2, 10)));  // with the one before
  ASSERT_TRUE(add(along(kX, 2, 11)));  // faster
  ASSERT_TRUE(add(along(kY, 2, 11)));
  ASSERT_TRUE(add(along(kY, -2, 11)));  // back
  ASSERT_TRUE(add({.delta = {1, 1, 0, 0, 0, 0}, .speed_per_s = 11}));
  ASSERT_TRUE(add({.delta = {2, 2, 0, 0, 0, 0}, .speed_per_s = 11}));
  ASSERT_TRUE(add({.delta = {2, 2.1, 0, 0, 0, 0}, .speed_per_s = 11}));
  const double x[] = {18, 20, 20, 20, 23, 25}, y[] = {-5, -5, -3, -5, -2, 0.1};
  for (int i = 0; i < 6; ++i) {
    const auto next = hand->take_jog();
    ASSERT_TRUE(next) << i;
    EXPECT_NEAR(next->target[kX], x[i], 1e-9) << i;
    EXPECT_NEAR(next->target[kY], y[i], 1e-9) << i;
    EXPECT_EQ(next->feed_per_s, i == 0 ? 10 : 11) << i;
  }
  EXPECT_FALSE(hand->take_jog());
  EXPECT_FALSE(add(along(kX, 500))) << "from where the last one ends";
  ASSERT_TRUE(add(along(kX, 1)));
  EXPECT_NEAR(hand->take_jog()->target[kX], 26, 1e-9);
  ASSERT_TRUE(add(along(kX, 1)));
  hand->end_jogs();
  EXPECT_FALSE(hand->take_jog());
  EXPECT_EQ(hand->jogs(), ManualMotion::Jogs::kNone);
}

TEST_F(ManualMotionTest, OneThatIsHeldIsWantedForAsLongAsItIsSaid) {
  const command::Jog held = along(kX, 500, 20, true);
  begin(held);
  EXPECT_EQ(hand->jogs(), ManualMotion::Jogs::kWhileHeld);
  const BusTime until = 1s + BusTime{command::kHeldJogPatience};
  EXPECT_FALSE(hand->let_go(until));
  EXPECT_TRUE(hand->let_go(until + 1ns));
  EXPECT_FALSE(hand->hold_on(2s, along(kX, -500, 20, true)));
  EXPECT_FALSE(hand->hold_on(2s, along(kY, 500, 20, true)));
  EXPECT_FALSE(hand->hold_on(2s, along(kE, 500, 20, true)));
  EXPECT_TRUE(hand->let_go(until + 1ns)) << "those were others";
  EXPECT_TRUE(hand->hold_on(2s, along(kX, 3, 20, true))) << "its direction counts";
  EXPECT_FALSE(hand->let_go(until + 1s));
  EXPECT_TRUE(hand->let_go(until + 1s + 1ns));
  begin(along(kX, 5));
  EXPECT_FALSE(hand->let_go(100s)) << "a step needs no holding";
}

TEST_F(ManualMotionTest, TheReferenceLeavesTheFilamentAsItIs) {
  const canonical::Command way = hand->reference(kHere);
  const auto& traverse = std::get<canonical::Traverse>(way);
  Pose wanted = kinematics->bed_reference();
  wanted[kE] = kHere[kE];
  EXPECT_EQ(traverse.target, wanted);
  EXPECT_EQ(traverse.frame, Frame::kMachine);
}

TEST_F(ManualMotionTest, TheToolIsLiftedAsFarAsEveryPlaceOnTheWayIsAllowed) {
  std::optional<Sentence> kept_from;
  const auto lifted_to = [&](const Pose& from, double z) {
    kept_from.reset();
    const auto up = hand->lift(from, z, kept_from);
    if (!up) return -1.;
    const auto& traverse = std::get<canonical::Traverse>(*up);
    Pose straight = from;
    straight[kZ] = traverse.target[kZ];
    EXPECT_EQ(traverse.target, straight);
    return straight[kZ];
  };
  EXPECT_NEAR(lifted_to(kHere, 45), 45, 1e-9);
  EXPECT_FALSE(kept_from);
  EXPECT_EQ(lifted_to(kHere, 39), -1) << "it is higher";
  EXPECT_EQ(lifted_to(kHere, 40.01 - 1e-9), -1) << "less frees no nozzle";
  EXPECT_NEAR(lifted_to(kHere, 40.02), 40.02, 1e-9);
  Pose low = top();
  low[kZ] -= 1.1;
  const double reached = lifted_to(low, low[kZ] + 5);
  EXPECT_NEAR(reached, low[kZ] + 1, 1e-6) << "in quarters of a millimetre";
  EXPECT_TRUE(kept_from);
  EXPECT_EQ(lifted_to(top(), top()[kZ] + 5), -1);
  EXPECT_TRUE(kept_from);
  Pose outside = kHere;
  outside[kX] = 300;
  EXPECT_EQ(lifted_to(outside, 45), -1);
  EXPECT_TRUE(kept_from);
}

TEST_F(ManualMotionTest, WhatLeadsSomewhereLeadsThereOnce) {
  using Then = ManualMotion::Then;
  EXPECT_TRUE(hand->leads_to(Then::kNothing));
  hand->start({{0, hand->reference(kHere)}}, kHere, 1, Then::kReturn);
  EXPECT_TRUE(hand->leads_to(Then::kReturn));
  EXPECT_TRUE(hand->runner().active());
  EXPECT_EQ(hand->take_then(), Then::kReturn);
  EXPECT_EQ(hand->take_then(), Then::kNothing);
}

}  // namespace
}  // namespace kinebus
