// The current that an axis gives its motor: how it comes and goes, what the bridges lose, what is measured.

#include <gtest/gtest.h>

#include <cmath>

#include "node_firmware/motor/tests/motor_model.hpp"

namespace kinebus::motor {
namespace {

double amperes(const Bench& bench) {
  return std::hypot(bench.motor.ia, bench.motor.ib);
}

TEST(AxisCurrent, TheMeasuredOneIsTheSameAtEveryAngle) {
  for (const double position : {0.0, 128.0, 256.0, 384.0, 512.0, 700.0}) {
    Bench bench;
    bench.position = position;
    bench.turn_to(position);
    bench.control.set_power(true);
    bench.run(0.5);
    EXPECT_NEAR(bench.control.measured_a(), 1.0, 0.05) << position;
  }
}

TEST(AxisCurrent, PowerComesWithASlopeInMotionToo) {
  Bench bench;
  bench.velocity = 2'000;
  bench.control.set_resting(false);
  bench.control.set_power(true);
  bench.run(0.01);
  EXPECT_NEAR(bench.control.amplitude_a(), 0.2, 0.02);
  bench.run(0.02);
  EXPECT_NEAR(bench.control.amplitude_a(), 0.6, 0.02);
}

TEST(AxisCurrent, PowerComesWithOneSlopeUpToTheRunCurrent) {
  Bench bench;
  bench.control.set_power(true);
  for (int i = 1; i <= 7; ++i) {
    bench.run(0.01);
    EXPECT_NEAR(bench.control.amplitude_a(), 0.2 * i, 0.01) << "hold, at 1 A, is nothing special";
  }
}

TEST(AxisCurrent, FromHoldToRunItComesAtOnceWhenItMovesAndGoesSlowly) {
  Bench bench;
  bench.control.set_power(true);
  bench.run(0.5);
  ASSERT_NEAR(bench.control.amplitude_a(), 1.0, 0.001);
  bench.velocity = 2'000;
  bench.run(0.0011);
  EXPECT_NEAR(bench.control.amplitude_a(), 1.5, 0.001);
  bench.velocity = 0;
  bench.run(0.19);
  EXPECT_NEAR(bench.control.amplitude_a(), 1.5, 0.001) << "it rests for 0.2 s first";
  bench.run(0.02);
  EXPECT_NEAR(bench.control.amplitude_a(), 1.3, 0.02);
}

TEST(AxisCurrent, AtRestEvenMoreIsGivenSlowly) {
  // Hold above run: more current than it had, and nothing moves.
  AxisConfig config = Bench::standard();
  config.run_a = 1.0F;
  config.hold_a = 1.5F;
  Bench bench(config);
  bench.control.set_power(true);
  bench.run(0.203);
  EXPECT_NEAR(bench.control.amplitude_a(), 1.06, 0.03);
  bench.run(0.1);
  EXPECT_NEAR(bench.control.amplitude_a(), 1.5, 0.001);
}

TEST(AxisCurrent, WhenPowerComesBackNothingOfBeforeIsLeftInTheLoop) {
  AxisConfig config = Bench::standard();
  config.motor.resistance_ohm = 8;
  Bench bench(config);
  bench.motor.resistance = 8;
  bench.control.set_power(true);
  bench.run(0.5);
  bench.control.set_power(false);
  bench.run(0.05);
  bench.control.set_power(true);
  double most = 0;
  for (int i = 0; i < 20; ++i) {
    bench.period();
    most = std::max(most, amperes(bench));
  }
  EXPECT_LT(most, 0.05) << "1 ms of the slope is 0.02 A";
}

TEST(AxisCurrent, WhatTheBridgesLoseIsGivenBack) {
  // Turning slowly the current passes through zero in each phase, where it would hang.
  const auto error_of = [](float given_back) {
    AxisConfig config = Bench::standard();
    config.dead_time_share = given_back;
    Bench bench(config);
    bench.lost_share = 0.02;
    bench.control.set_resting(false);
    bench.control.set_power(true);
    bench.run(0.3);
    bench.velocity = 40'000;
    bench.run(0.1);
    double square = 0;
    for (int i = 0; i < 4000; ++i) {
      bench.period();
      square += std::pow(amperes(bench) - 1.5, 2);
    }
    return std::sqrt(square / 4000);
  };
  EXPECT_LT(error_of(0.02F), 0.5 * error_of(0));
}

TEST(AxisCurrent, ASupplyOfAnotherVoltageIsReckonedWith) {
  for (const double supply : {16.0, 24.0, 28.0}) {
    AxisConfig config = Bench::standard();
    config.motor_measured = false;
    Bench bench(config);
    bench.supply = supply;
    bench.control.set_power(true);
    bench.run(0.3);
    bench.control.request_tune();
    bench.run(0.1);
    EXPECT_NEAR(bench.control.amplitude_a(), 0.6, 0.001) << "what the measurement asks for";
    bench.run(0.9);
    ASSERT_EQ(bench.control.tune_state(), AutoTune::State::kDone) << supply;
    EXPECT_NEAR(bench.control.tune_result().inductance_h, 2.2e-3, 0.08 * 2.2e-3) << supply;
  }
}

TEST(AxisCurrent, FromAMeasurementTheCurrentGoesOnWithItsSlope) {
  Bench bench;
  bench.control.set_power(true);
  bench.run(0.3);
  bench.control.request_tune();
  bench.period();
  while (bench.control.tune_state() == AutoTune::State::kRuns) bench.period();
  ASSERT_EQ(bench.control.tune_state(), AutoTune::State::kDone);
  for (int i = 0; i < 400; ++i) {
    bench.period();
    ASSERT_NEAR(amperes(bench), bench.control.amplitude_a(), 0.12) << i << " periods after it";
  }
}

TEST(AxisCurrent, AnInvertedAxisIsAsFastAsAnother) {
  // Back-EMF and inductance are reckoned with the motor's sense.
  double worst[2] = {};
  for (const bool inverted : {false, true}) {
    AxisConfig config = Bench::standard();
    config.inverted = inverted;
    Bench bench(config);
    bench.control.set_power(true);
    bench.run(0.3);
    while (bench.velocity < 512'000) {
      bench.velocity += 6.4e6 * 50e-6;
      bench.period();
      const double commanded = inverted ? -bench.position : bench.position;
      worst[inverted ? 1 : 0] = std::max(worst[inverted ? 1 : 0], std::abs(bench.motor.counts() - commanded));
    }
  }
  EXPECT_NEAR(worst[0], worst[1], 1.0);
  EXPECT_LT(worst[0], 10) << "counts";
}

}  // namespace
}  // namespace kinebus::motor
