// A carriage that is not where its motor's counts say: how the motor is led there, to the count.
#include "node_firmware/core/scale_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinebus::testing_scale {
namespace {

using namespace std::chrono_literals;

constexpr LocalTime kPeriod = ScaleCorrection::kPeriod;
constexpr double kOne = 4294967296.0;

/// 25.6 counts of the motor for one of the scale; 1,000 either way, 2,000 a second.
const ScaleCorrection::Settings kSettings{25 * 65536 + 39322, 1000, 2000};
constexpr double kRatio = 25.6;

using Finding = ScaleCorrection::Finding;

class Bench {
 public:
  explicit Bench(ScaleCorrection::Settings of = kSettings) : settings(of) {}

  /// Looks with the axis at `command`, and the carriage where motor counts would put `carriage`.
  Finding look(double command, double carriage) {
    now += kPeriod;
    return correction.look(settings, {now, static_cast<std::int64_t>(std::llround(command)),
                                      static_cast<std::int64_t>(std::llround(carriage / kRatio))});
  }
  double added(LocalTime after = 0ms) const { return static_cast<double>(correction.at(now + after)) / kOne; }

  ScaleCorrection::Settings settings;
  ScaleCorrection correction;
  LocalTime now = 5s;
};

TEST(ScaleCorrection, AddsAnEvenShareOfTheErrorAtEachLook) {
  for (const double sign : {1.0, -1.0}) {
    Bench b;
    EXPECT_FALSE(b.correction.running());
    EXPECT_EQ(b.look(0, 0), Finding::kGood);
    EXPECT_TRUE(b.correction.running());
    EXPECT_EQ(b.added(1s), 0) << "the first look is where home is";
    // The carriage is 10 counts of the scale behind: 256 of the motor, 2 a look.
    EXPECT_EQ(b.look(sign * 256, 0), Finding::kGood);
    EXPECT_EQ(b.added(), 0);
    EXPECT_NEAR(b.added(500us), sign * 1, 0.001) << "2,000 a second";
    EXPECT_NEAR(b.added(1ms), sign * 2, 0.001);
    EXPECT_NEAR(b.added(kPeriod), sign * 2, 0.001);
    EXPECT_EQ(b.added(-1ms), 0) << "before";
    EXPECT_NEAR(b.added(100s), sign * 2, 0.001);
    EXPECT_EQ(b.look(sign * 256, 0), Finding::kGood);
    EXPECT_NEAR(b.added(kPeriod), sign * 4, 0.001);
    // It comes over: what is added counts on from where it is, and half a count of the scale is no error.
    EXPECT_EQ(b.look(sign * 256, sign * 256), Finding::kGood);
    EXPECT_NEAR(b.added(kPeriod), sign * 4, 0.001);
    EXPECT_EQ(b.look(sign * (256 + 12), sign * 256), Finding::kGood);
    EXPECT_NEAR(b.added(kPeriod), sign * 4, 0.001) << "12 of 12.8";
    // 14, or 13 where the scale's counts are rounded down.
    EXPECT_EQ(b.look(sign * (256 + 14), sign * 256), Finding::kGood);
    EXPECT_NEAR(b.added(kPeriod), sign * (4 + 13.5 / 128), 0.005);
  }
}

TEST(ScaleCorrection, ComesToTheErrorWithATimeConstantOf128Looks) {
  Bench b;
  b.look(0, 0);
  double led = 0;
  for (int k = 1; k <= 2000; ++k) {
    EXPECT_EQ(b.look(200, led), Finding::kGood) << k;
    led = b.added(kPeriod);
    if (k == 128) {
      EXPECT_NEAR(led, 200 * (1 - std::exp(-1.0)), 15);
    }
  }
  EXPECT_NEAR(led, 200, kRatio);
  EXPECT_LE(led, 200 + 1e-3);
}

TEST(ScaleCorrection, LeadsNoFartherAndNoFasterThanItMay) {
  for (const double sign : {1.0, -1.0}) {
    Bench b({kSettings.ratio_q16, 40, 100});
    b.look(0, 0);
    double last = 0;
    for (int k = 0; k < 3000; ++k) {
      // In motion all the time, but slow; 35 counts are what the drift may be.
      b.look(sign * (5000 + k % 2), sign * (5000 + k % 2 - (k < 1500 ? 2000 : 0)));
      const double is = b.added(kPeriod);
      EXPECT_LE(std::abs(is), 40 + 1e-6);
      EXPECT_LE(std::abs(is - last), 1.001);
      last = is;
      if (k == 1499) {
        EXPECT_NEAR(is, sign * 40, 1e-6);
      }
    }
    EXPECT_NEAR(last, sign * 40, 1e-6) << "no error: it stays";
  }
}

TEST(ScaleCorrection, AScaleThatDoesNotCountOnAWayOfMoreThanItMayStands) {
  // 1,000 and 20 counts of the scale.
  for (const double sign : {1.0, -1.0}) {
    Bench b;
    b.look(0, 0);
    EXPECT_EQ(b.look(sign * 200, sign * 200), Finding::kGood);
    double at = 200;
    while (at + 100 <= 200 + 1000 + 20 * kRatio) {
      at += 100;
      EXPECT_NE(b.look(sign * at, sign * 200), Finding::kStands) << at;
    }
    EXPECT_NE(b.look(sign * (200 + 1000 + 511), sign * 200), Finding::kStands);
    EXPECT_EQ(b.look(sign * (200 + 1000 + 513), sign * 200), Finding::kStands);
    EXPECT_NE(b.look(sign * (200 + 1000 + 513), sign * 200), Finding::kStands) << "it moves no more";
  }
}

TEST(ScaleCorrection, ACarriageFartherAwayThanItMayBeIsTold) {
  for (const double sign : {1.0, -1.0}) {
    Bench b;
    b.look(0, 0);
    EXPECT_EQ(b.look(sign * 5000, sign * 3980), Finding::kGood) << "in a fast motion it lags";
    EXPECT_EQ(b.look(sign * 5001, sign * 3984), Finding::kFarAway);
    EXPECT_EQ(b.look(sign * 5001, sign * 3984), Finding::kGood) << "it moves no more";
    EXPECT_EQ(b.look(sign * 5010, sign * 4045), Finding::kGood);
    // What it is led by counts as well: it would be so much farther away.
    for (int k = 0; k < 100; ++k) b.look(sign * (5010 + k % 2), sign * 4045);
    EXPECT_GT(sign * b.added(), 100);
    EXPECT_EQ(b.look(sign * 5012, sign * 4045), Finding::kFarAway);
    EXPECT_EQ(b.look(sign * 5010, sign * (5010 - 1000 + std::abs(b.added()) + 60)), Finding::kGood);
  }
}

TEST(ScaleCorrection, InAFastMotionItIsLedNoFarther) {
  Bench b;
  b.look(0, 0);
  b.look(500, 0);
  b.look(500, 0);
  ASSERT_GT(b.added(kPeriod), 3.9);
  // 10 counts of the scale a look are fast: from 257 on.
  b.look(757, 257);
  const double held = b.added();
  EXPECT_NEAR(b.added(kPeriod), held, 1e-9);
  EXPECT_NEAR(b.added(1s), held, 1e-9);
  b.look(757 + 255, 512);
  EXPECT_GT(b.added(kPeriod), held + 1);
}

TEST(ScaleCorrection, HeldItStaysWhereItIsAndTheNextLookIsHome) {
  Bench b({kSettings.ratio_q16, 40, 2000});
  b.look(0, 0);
  for (int k = 0; k < 400; ++k) b.look(3000, 2000);
  EXPECT_NEAR(b.added(), 40, 1e-6);
  b.look(3000, 2000);
  b.correction.hold(b.now + 100us);
  EXPECT_FALSE(b.correction.running());
  EXPECT_NEAR(b.added(1s), 40, 1e-6);
  b.now += 1s;
  EXPECT_EQ(b.look(-90000, 55555), Finding::kGood) << "wherever it is, that is home";
  EXPECT_TRUE(b.correction.running());
  EXPECT_NEAR(b.added(1s), 40, 1e-6);
  for (int k = 0; k < 400; ++k) b.look(0, 1000);
  EXPECT_NEAR(b.added(), 0, 1e-6) << "so far either way from where it was held";
  ScaleCorrection idle;
  idle.hold(1s);
  EXPECT_FALSE(idle.running());
  EXPECT_EQ(idle.at(2s), 0);
}

TEST(ScaleCorrection, HeldOnTheWayItGoesNoFarther) {
  Bench b;
  b.look(0, 0);
  b.look(2560 / 2, 0);
  b.look(2560 / 2, 0);  // 10 counts in 5 ms
  const LocalTime held = b.now + 2ms;
  const std::int64_t there = b.correction.at(held);
  EXPECT_GT(there, b.correction.at(b.now));
  b.correction.hold(held);
  EXPECT_EQ(b.correction.at(held), there);
  EXPECT_EQ(b.correction.at(held + 5ms), there);
}

TEST(ScaleCorrection, NumbersBeyondAnyMachineDoNotLeaveTheirBounds) {
  Bench b({0x7FFF'FFFF, std::int64_t{1} << 40, 1'000'000'000});
  b.look(0, 0);
  for (const std::int64_t scale : {std::int64_t{1} << 40, -(std::int64_t{1} << 40)})
    for (int k = 0; k < 50; ++k) {
      b.now += kPeriod;
      b.correction.look(b.settings, {b.now, k, scale});
      EXPECT_LE(std::abs(b.added(kPeriod)), std::ldexp(1, 30));
    }
}

TEST(ScaleCorrection, WhatItWasOnItsWayToIsGivenUpWhenItIsNoLongerKnownToBeRight) {
  for (const bool fast : {true, false}) {
    Bench b({kSettings.ratio_q16, 1000, 100});
    b.look(0, 0);
    b.look(250, 0);
    EXPECT_NEAR(b.added(kPeriod), 1, 0.001) << "of 2";
    // Fast, or come over in the meantime.
    fast ? b.look(750, 256) : b.look(250, 256);
    EXPECT_NEAR(b.added(), 1, 0.001);
    EXPECT_NEAR(b.added(1s), 1, 0.001) << fast;
  }
}

TEST(ScaleCorrection, AtItsBoundsAllIsStillGood) {
  constexpr std::int32_t kFour = 4 * 65536;
  const auto look = [](ScaleCorrection& c, LocalTime now, std::int64_t command, std::int64_t scale) {
    return c.look({kFour, 1000, 2000}, {now, command, scale});
  };
  for (const std::int64_t sign : {1, -1}) {
    ScaleCorrection stands, far;
    look(stands, 1s, 0, 0);
    EXPECT_NE(look(stands, 2s, sign * 1080, 0), Finding::kStands);
    EXPECT_EQ(look(stands, 3s, sign * 1081, 0), Finding::kStands);
    look(far, 1s, 0, 0);
    look(far, 2s, sign * 4000, sign * 1000);
    EXPECT_EQ(look(far, 3s, sign * 4020, sign * 755), Finding::kGood) << "1,000";
    EXPECT_EQ(look(far, 3s, sign * 4021, sign * 755), Finding::kFarAway) << "1,001";
  }
}

}  // namespace
}  // namespace kinebus::testing_scale
