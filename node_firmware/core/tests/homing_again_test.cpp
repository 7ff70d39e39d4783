// Homing that hears what it does not ask for, is begun again, or loses what it homes by.

#include <gtest/gtest.h>

#include <cmath>

#include "node_firmware/core/homing.hpp"

namespace kinebus {
namespace {

constexpr HomingConfig kConfig{.method = 19,
                               .fast = 40'000,
                               .slow = 4'000,
                               .acceleration = 1'000'000,
                               .offset = 0,
                               .travel = 400'000,
                               .back_off = 20'000};
constexpr ProfileTicks kSecond = kTicksPerSecond;

struct HomingAgain : testing::Test {
  void begin(int method, bool active = false) {
    HomingConfig config = kConfig;
    config.method = method;
    homing.start(now, config, active, motion);
  }
  void wait(ProfileTicks span) {
    for (const ProfileTicks end = now + span; now < end;) {
      now = std::min(end, now + 1600);
      homing.on_time(now, motion);
      std::int64_t by = 0;
      if (homing.take_shift(by)) ++shifts;
    }
  }
  void hear(bool active) { homing.on_switch(now, active, motion.at(now).position, motion); }
  double speed() const { return std::ldexp(static_cast<double>(motion.at(now).velocity), -56) * 16e6; }
  void expect_moves(double at) { EXPECT_NEAR(speed(), at, 10); }

  Trapezoid motion;
  Homing homing;
  ProfileTicks now = 0;
  int shifts = 0;
};

TEST_F(HomingAgain, ALevelThatItDoesNotLookForChangesNothing) {
  begin(20);
  wait(kSecond / 5);
  expect_moves(40'000);
  hear(false);
  wait(kSecond / 5);
  expect_moves(40'000);
  hear(true);
  wait(kSecond / 5);
  expect_moves(-40'000);  // off it, to make way for the run-up: fast
  hear(true);
  wait(kSecond / 50);
  expect_moves(-40'000);
  hear(false);
  wait(kSecond / 5);
  expect_moves(4'000);  // back to it slowly
  hear(false);
  wait(kSecond / 5);
  expect_moves(4'000);
  hear(true);
  wait(kSecond);
  EXPECT_TRUE(homing.attained());
  EXPECT_EQ(shifts, 1);
}

TEST_F(HomingAgain, AMethodThatTakesTheEdgeOnTheWayOffLeavesSlowly) {
  for (const int method : {17, 18, 19, 21}) {
    begin(method, true);
    wait(kSecond / 5);
    expect_moves(method == 18 || method == 19 ? -4'000 : 4'000);
    homing.abort();
    motion.hold(0);
  }
  for (const int method : {20, 22}) {
    begin(method, true);
    wait(kSecond / 5);
    expect_moves(method == 20 ? -40'000 : 40'000);
    homing.abort();
    motion.hold(0);
  }
}

TEST_F(HomingAgain, WhatIsAbortedIsNotAttained) {
  begin(35);
  wait(kSecond / 10);
  ASSERT_TRUE(homing.attained());
  homing.abort();
  EXPECT_FALSE(homing.attained());
}

TEST_F(HomingAgain, WhatFailsInMotionComesToRestAtOnce) {
  begin(19);
  wait(kSecond / 5);
  hear(true);
  wait(kSecond / 200);  // it brakes on its switch
  hear(false);
  ASSERT_EQ(homing.error(), HomingError::kBounced);
  const std::int64_t here = motion.at(now).position;
  wait(kSecond);
  EXPECT_TRUE(motion.done(now));
  EXPECT_EQ(speed(), 0);
  EXPECT_LT(motion.at(now).position - here, from_counts(1'000));
  begin(35);
  EXPECT_EQ(homing.error(), HomingError::kNone);
}

/// Presses where it is told to, each time.
struct HomingByLoadAgain : HomingAgain {
  HomingByLoadAgain() { homing.set_load(Homing::Load::kReady); }
  void to_stop(std::int64_t counts, int way) {
    for (int i = 0; i < 30'000 && homing.running(); ++i) {
      wait(1600);
      if ((motion.at(now).position - from_counts(counts)) * way >= 0 && speed() * way > 20'000) break;
    }
    hear(true);
  }
  void off() {
    hear(false);
    wait(kSecond / 5);
  }
};

TEST_F(HomingByLoadAgain, ItMeetsItsStopTwiceEachTime) {
  for (int time = 1; time <= 2; ++time) {
    begin(-3);
    wait(kSecond);
    expect_moves(40'000);
    to_stop(50'000, 1);
    ASSERT_TRUE(homing.running());
    wait(kSecond / 100);
    off();
    ASSERT_EQ(shifts, time - 1) << "met once it is no home";
    to_stop(50'000, 1);
    off();
    wait(kSecond);
    EXPECT_TRUE(homing.attained()) << time;
    EXPECT_EQ(shifts, time);
    motion.hold(0);
  }
}

TEST_F(HomingByLoadAgain, TheSecondMeetingIsWithin512CountsOfTheFirst) {
  for (const int method : {-3, -4})
    for (const int off_by : {-600, -400, 0, 400, 600}) {
      SCOPED_TRACE(testing::Message() << method << " " << off_by);
      const int way = method == -3 ? 1 : -1;
      homing = {};
      homing.set_load(Homing::Load::kReady);
      motion.hold(0);
      begin(method);
      wait(kSecond);
      homing.on_switch(now, true, from_counts(50'000 * way), motion);
      wait(kSecond / 100);
      off();
      wait(kSecond / 2);
      homing.on_switch(now, true, from_counts(50'000 * way + off_by), motion);
      EXPECT_EQ(homing.error(), std::abs(off_by) > 512 ? HomingError::kBounced : HomingError::kNone);
      const std::int64_t here = motion.at(now).position;
      wait(kSecond / 10);
      if (homing.error() == HomingError::kNone) continue;
      EXPECT_TRUE(motion.done(now)) << "it does not press on";
      EXPECT_LT((motion.at(now).position - here) * way, from_counts(1'000));
    }
}

TEST_F(HomingByLoadAgain, ADriverThatFallsSilentAndALoadThatStaysEndIt) {
  begin(-3);
  wait(kSecond / 100);
  homing.set_load(Homing::Load::kNone);
  wait(kSecond);
  EXPECT_EQ(homing.error(), HomingError::kNoLoad);
  homing.set_load(Homing::Load::kReady);
  motion.hold(0);
  begin(-3);
  hear(true);  // while it goes free, and for good
  wait(kSecond);
  EXPECT_EQ(homing.error(), HomingError::kStuck);
  // A load that goes before the axis presses is none.
  motion.hold(0);
  begin(-3);
  hear(true);
  hear(false);
  wait(kSecond);
  EXPECT_EQ(homing.error(), HomingError::kNone);
  expect_moves(40'000);
  hear(false);
  wait(kSecond / 10);
  expect_moves(40'000);
}

TEST_F(HomingByLoadAgain, AtTheSecondMeetingItGoesNoFartherThanAgreementAllows) {
  begin(-3);
  wait(kSecond);
  homing.on_switch(now, true, motion.at(now).position, motion);
  const std::int64_t first = motion.at(now).position;
  wait(kSecond / 100);
  off();
  wait(5 * kSecond);
  EXPECT_EQ(homing.error(), HomingError::kBounced);
  EXPECT_LT(motion.at(now).position - first, from_counts(2'500));
}

}  // namespace
}  // namespace kinebus
