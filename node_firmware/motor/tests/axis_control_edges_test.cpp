// The control where something is not as usual: mirrored, jumping, lost, found wrong, switched on again.

#include <gtest/gtest.h>

#include <cmath>

#include "node_firmware/motor/tests/motor_model.hpp"

namespace kinebus::motor {
namespace {

AxisConfig watched() {
  AxisConfig config = Bench::standard();
  config.encoder = EncoderMode::kWatch;
  return config;
}

TEST(AxisControlEdges, AnInvertedAxisIsTheSameMirrored) {
  AxisConfig config = watched();
  config.inverted = true;
  Bench bench(config);
  bench.encoder_present = true;
  bench.control.set_power(true);
  bench.run(0.3);
  for (const double velocity : {20'000.0, -35'000.0, 0.0}) {
    bench.velocity = velocity;
    bench.run(0.2);
    EXPECT_NEAR(bench.motor.counts(), -bench.position, 60) << velocity;
    EXPECT_LT(std::abs(bench.control.following_error()), 60) << velocity;
  }
  bench.motor.blocked = true;
  bench.velocity = 50'000;
  bench.run(0.05);
  EXPECT_GT(bench.control.following_error(), 1024) << "with the sense of the command";
  EXPECT_EQ(bench.control.troubles(), Surroundings::kFollowing);
}

TEST(AxisControlEdges, ACommandThatJumpsTakesThePower) {
  for (const int way : {1, -1}) {
    Bench bench;
    bench.control.set_power(true);
    bench.run(0.3);
    bench.position += way * 1000;
    bench.period();
    EXPECT_EQ(bench.control.tripped(), fault::kSoftware) << way;
    EXPECT_FALSE(bench.out.power) << way;
  }
}

TEST(AxisControlEdges, AFaultStaysUntilItIsAcknowledgedAndPowerThenComesAnew) {
  Bench bench;
  bench.control.set_power(true);
  bench.run(0.3);
  EXPECT_NEAR(bench.control.measured_a(), 1.0, 0.1);
  bench.position += 1000;
  bench.period();
  for (int i = 0; i < 2000; ++i) {
    bench.period();
    ASSERT_FALSE(bench.out.power);
  }
  EXPECT_EQ(bench.control.measured_a(), 0);
  EXPECT_EQ(bench.control.amplitude_a(), 0);
  bench.control.acknowledge();
  bench.period();
  EXPECT_EQ(bench.control.tripped(), fault::kNone);
  bench.run(0.001);
  EXPECT_TRUE(bench.out.power);
  EXPECT_LT(bench.control.amplitude_a(), 0.75) << "with its slope";
  double most = 0;
  const double began = bench.motor.counts();
  for (int i = 0; i < 4000; ++i) {
    bench.period();
    most = std::max(most, std::abs(bench.motor.counts() - began));
  }
  EXPECT_LT(most, 300) << "it is drawn to a full step at most";
  EXPECT_NEAR(bench.control.measured_a(), 1.5, 0.1) << "the rest is counted anew";
}

TEST(AxisControlEdges, PowerThatGoesAndComesHasItsSlopeAgain) {
  Bench bench;
  bench.control.set_power(true);
  bench.run(0.3);
  bench.control.set_power(false);
  bench.period();
  bench.period();
  EXPECT_FALSE(bench.out.power);
  EXPECT_EQ(bench.control.amplitude_a(), 0);
  bench.control.set_power(true);
  bench.run(0.001);
  EXPECT_TRUE(bench.out.power);
  EXPECT_LT(bench.control.amplitude_a(), 0.75);
}

TEST(AxisControlEdges, AnEncoderThatIsLostIsToldAndForgottenWhenItIsBack) {
  for (const EncoderMode mode : {EncoderMode::kWatch, EncoderMode::kClosedLoop}) {
    AxisConfig config = watched();
    config.encoder = mode;
    Bench bench(config);
    bench.encoder_present = true;
    bench.control.set_power(true);
    bench.run(0.3);
    EXPECT_EQ(bench.control.troubles(), 0);
    bench.encoder_present = false;
    bench.velocity = 10'000;
    bench.run(0.1);
    EXPECT_EQ(bench.control.troubles(), Surroundings::kEncoder);
    EXPECT_EQ(bench.control.following_error(), 0) << "nobody knows";
    EXPECT_NEAR(bench.motor.counts(), bench.position, 60) << "and it goes on as one without";
    bench.encoder_present = true;
    bench.run(0.1);
    EXPECT_EQ(bench.control.troubles(), 0);
    EXPECT_NEAR(bench.motor.counts(), bench.position, 60);
    EXPECT_LT(std::abs(bench.control.following_error()), 60);
  }
}

TEST(AxisControlEdges, CurrentIsRaisedWhileItAccelerates) {
  AxisConfig config = Bench::standard();
  config.boost_a = 2.5F;
  Bench bench(config);
  bench.control.set_power(true);
  bench.control.set_resting(false);
  bench.run(0.3);
  EXPECT_NEAR(bench.control.amplitude_a(), 1.5, 0.01);
  for (int way : {1, -1}) {
    for (int i = 0; i < 400; ++i) {
      bench.velocity += way * 200;
      bench.period();
    }
    EXPECT_NEAR(bench.control.amplitude_a(), 2.5, 0.05) << way;
    bench.run(0.2);
    EXPECT_NEAR(bench.control.amplitude_a(), 1.5, 0.01) << way;
  }
}

TEST(AxisControlEdges, EachPhaseIsWatchedBothWays) {
  for (const auto& [a, b] : {std::pair{4.5, 0.0}, {-4.5, 0.0}, {0.0, 4.5}, {0.0, -4.5}}) {
    Bench bench;
    bench.control.set_power(true);
    bench.run(0.3);
    for (int i = 0; i < 2; ++i) {
      bench.motor.ia = a;
      bench.motor.ib = b;
      bench.period();
    }
    EXPECT_EQ(bench.control.tripped(), fault::kOverCurrent) << a << " " << b;
  }
}

TEST(AxisControlEdges, ShortedTurnsAreLookedForWhereTheMotorWasMeasured) {
  for (const bool measured : {true, false}) {
    AxisConfig config = Bench::standard();
    config.motor_measured = measured;
    Bench bench(config);
    bench.motor.resistance = 0.3;
    bench.control.set_power(true);
    bench.run(0.4);
    EXPECT_EQ(bench.control.tripped(), measured ? fault::kShortCircuit : fault::kNone);
    EXPECT_EQ(bench.out.power, !measured);
  }
}

TEST(AxisControlEdges, TheMeasurementFindsTheEncodersZeroWhichThenTellsTheFirstAngle) {
  Bench measured(watched());
  measured.encoder_present = true;
  measured.encoder_zero = 0.3;
  measured.control.set_power(true);
  measured.run(0.3);
  measured.control.request_tune();
  measured.run(1.0);
  ASSERT_EQ(measured.control.tune_state(), AutoTune::State::kDone);
  const std::int32_t offset = measured.control.tuned_encoder_offset();
  EXPECT_NEAR(offset, std::fmod(0.3 / (2 * std::numbers::pi) * 51'200, 1024), 6);

  AxisConfig config = watched();
  config.encoder_offset = offset;
  for (const double stands : {400.0, -300.0})
    for (const double commanded : {0.0, 700.0}) {
      Bench bench(config);
      bench.encoder_present = true;
      bench.encoder_zero = 0.3;
      bench.position = commanded;
      bench.motor.theta = stands / 512 * std::numbers::pi / 50;
      bench.run(0.005);
      bench.control.set_power(true);
      bench.run(0.3);
      EXPECT_NEAR(bench.motor.counts(), stands, 10) << "commanded " << commanded;
    }
}

TEST(AxisControlEdges, WhatIsNoMotorIsNoMeasurement) {
  AxisConfig config = Bench::standard();
  config.motor_measured = false;
  for (const auto& [resistance, inductance] : {std::pair{90.0, 2e-3}, {1.2, 0.2}, {1.2, 70e-3}}) {
    Bench bench(config);
    bench.motor.resistance = resistance;
    bench.motor.inductance = inductance;
    bench.control.set_power(true);
    bench.run(0.3);
    bench.control.request_tune();
    bench.run(1.0);
    EXPECT_TRUE(bench.control.tune_state() == AutoTune::State::kFailed ||
                bench.control.tripped() != fault::kNone)
        << resistance << " " << inductance;
  }
}

TEST(AxisControlEdges, NothingIsMeasuredInMotion) {
  Bench bench;
  bench.control.set_power(true);
  bench.run(0.3);
  bench.velocity = 5'000;
  bench.run(0.01);
  bench.control.request_tune();
  bench.run(0.1);
  EXPECT_EQ(bench.control.tune_state(), AutoTune::State::kIdle);
  EXPECT_NEAR(bench.motor.counts(), bench.position, 60);
}

TEST(AxisControlEdges, AFaultEndsAMeasurement) {
  Bench bench;
  bench.control.set_power(true);
  bench.run(0.3);
  bench.control.request_tune();
  bench.run(0.1);
  EXPECT_EQ(bench.control.tune_state(), AutoTune::State::kRuns);
  for (int i = 0; i < 2; ++i) {
    bench.motor.ia = 4.5;
    bench.period();
  }
  ASSERT_EQ(bench.control.tripped(), fault::kOverCurrent);
  bench.control.acknowledge();
  bench.run(1.5);
  EXPECT_NE(bench.control.tune_state(), AutoTune::State::kDone);
  EXPECT_NEAR(bench.control.measured_a(), 1.0, 0.1) << "it holds, as after any power-up";
}

TEST(AxisControlEdges, AConfigurationIsTakenWholeByTheNextPeriod) {
  Bench bench;
  bench.period();
  AxisConfig config = Bench::standard();
  config.run_a = 0.8F;
  config.hold_a = 0.8F;
  EXPECT_TRUE(bench.control.configure(config));
  EXPECT_FALSE(bench.control.configure(Bench::standard())) << "the last one is not taken yet";
  bench.period();
  bench.control.set_power(true);
  bench.run(0.5);
  EXPECT_NEAR(bench.control.measured_a(), 0.8, 0.05);
  EXPECT_TRUE(bench.control.configure(Bench::standard()));
}

TEST(AxisControlEdges, TheSameConfigurationComingAgainLosesNoFollowingError) {
  AxisConfig config = watched();
  Bench bench(config);
  bench.encoder_present = true;
  bench.control.set_power(true);
  bench.run(0.3);
  bench.motor.blocked = true;
  bench.velocity = 50'000;
  for (int i = 0; i < 100; ++i) {
    static_cast<void>(bench.control.configure(config));
    bench.run(0.001);
  }
  EXPECT_EQ(bench.control.troubles(), Surroundings::kFollowing);
}

}  // namespace
}  // namespace kinebus::motor
