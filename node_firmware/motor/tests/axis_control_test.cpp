#include "node_firmware/motor/axis_control.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "node_firmware/motor/tests/motor_model.hpp"

namespace kinebus::motor {
namespace {

TEST(AxisControl, PowerComesAndTheRotorStays) {
  // The rotor was left at a third of a full step, where the command stands too.
  Bench bench;
  bench.position = 85;
  bench.motor.theta = 85.0 / 512 * std::numbers::pi / 50;
  bench.run(0.001);
  bench.control.set_power(true);
  double most = 0;
  for (int i = 0; i < 4000; ++i) {
    bench.period();
    most = std::max(most, std::abs(bench.motor.counts() - 85));
  }
  EXPECT_LT(most, 2);
  EXPECT_NEAR(std::hypot(bench.motor.ia, bench.motor.ib), 1.5, 0.05);
}

TEST(AxisControl, EncoderTellsTheFirstAngle) {
  AxisConfig config = Bench::standard();
  config.encoder = EncoderMode::kWatch;
  config.encoder_offset = 0;
  Bench bench(config);
  bench.encoder_present = true;
  bench.motor.theta = 400.0 / 512 * std::numbers::pi / 50;  // nobody told the command
  bench.run(0.001);
  bench.control.set_power(true);
  double most = 0;
  for (int i = 0; i < 4000; ++i) {
    bench.period();
    most = std::max(most, std::abs(bench.motor.counts() - 400));
  }
  EXPECT_LT(most, 6) << "two steps of the encoder";
  EXPECT_LE(std::abs(bench.control.following_error()), 4);
}

TEST(AxisControl, OneNoisyReadingIsNotTheFirstAngle) {
  AxisConfig config = Bench::standard();
  config.encoder = EncoderMode::kWatch;
  config.encoder_offset = 0;
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
    Bench bench(config);
    bench.encoder_present = true;
    bench.encoder_noise_steps = 3.1;  // 10 counts, as bad as the data sheet allows
    bench.random.seed(seed);
    bench.motor.theta = 400.0 / 512 * std::numbers::pi / 50;
    bench.run(0.005);
    bench.control.set_power(true);
    bench.run(0.3);
    EXPECT_NEAR(bench.motor.counts(), 400, 7) << "seed " << seed;
  }
}

TEST(AxisControl, HoldCurrentComesAfterARest) {
  Bench bench;
  bench.control.set_power(true);
  bench.run(0.15);
  EXPECT_NEAR(bench.control.amplitude_a(), 1.5F, 0.01F);
  bench.run(0.3);
  EXPECT_NEAR(bench.control.amplitude_a(), 1.0F, 0.01F);
}

TEST(AxisControl, CurrentIsTheMeasuredOneNotTheOneAskedFor) {
  Bench bench;
  EXPECT_EQ(bench.control.measured_a(), 0);
  bench.control.set_power(true);
  bench.run(0.15);
  EXPECT_NEAR(bench.control.measured_a(), 1.5F, 0.05F);
  // The supply cannot drive it through a contact that has gone bad.
  bench.motor.resistance = 30;
  bench.run(0.04);
  EXPECT_EQ(bench.control.tripped(), fault::kNone);
  EXPECT_NEAR(bench.control.amplitude_a(), 1.5F, 0.01F);
  EXPECT_LT(bench.control.measured_a(), 1.2F);
  EXPECT_NEAR(bench.control.measured_a(), std::hypot(bench.motor.ia, bench.motor.ib), 0.05);
  bench.control.set_power(false);
  bench.run(0.001);
  EXPECT_EQ(bench.control.measured_a(), 0);
}

TEST(AxisControl, FollowsFromRestToTenTurnsASecond) {
  Bench bench;
  bench.control.set_power(true);
  bench.run(0.3);
  double worst = 0;
  // 6.4e6 counts/s^2 to 512,000 counts/s: the default carriage's 5000 mm/s^2 to 400 mm/s.
  while (bench.velocity < 512'000) {
    bench.velocity += 6.4e6 * 50e-6;
    bench.period();
    worst = std::max(worst, std::abs(bench.motor.counts() - bench.position));
  }
  bench.run(0.2);
  worst = std::max(worst, std::abs(bench.motor.counts() - bench.position));
  EXPECT_LT(worst, 51) << "two tenths of a full step, in counts";
  EXPECT_EQ(bench.control.tripped(), fault::kNone);
}

TEST(AxisControl, OpenPhaseIsFound) {
  Bench bench;
  bench.control.set_power(true);
  bench.run(0.3);
  bench.motor.open_a = true;
  bench.run(0.02);
  EXPECT_EQ(bench.control.tripped(), fault::kPhaseOpen);
  EXPECT_FALSE(bench.out.power);
}

TEST(AxisControl, ShortedTurnsAreFound) {
  Bench bench;
  bench.motor.resistance = 0.15;
  bench.motor.inductance = 0.3e-3;
  bench.control.set_power(true);
  bench.run(0.4);
  const bool found =
      bench.control.tripped() == fault::kShortCircuit || bench.control.tripped() == fault::kOverCurrent;
  EXPECT_TRUE(found) << std::hex << bench.control.tripped();
}

TEST(AxisControl, OverCurrentSwitchesOffWithinTwoPeriods) {
  Bench bench;
  bench.control.set_power(true);
  bench.run(0.3);
  bench.motor.ia = 4.5;
  bench.period();
  bench.motor.ia = 4.5;
  bench.period();
  EXPECT_EQ(bench.control.tripped(), fault::kOverCurrent);
  EXPECT_FALSE(bench.out.power);
  bench.motor.ia = 0;
  bench.control.set_power(false);
  bench.control.acknowledge();
  bench.period();
  EXPECT_EQ(bench.control.tripped(), fault::kNone);
}

TEST(AxisControl, SupplyAndHeatAreTroublesWithAWayBack) {
  Bench bench;
  bench.control.set_power(true);
  bench.run(0.1);
  bench.supply = 8;
  bench.run(0.01);
  EXPECT_EQ(bench.control.troubles(), Surroundings::kUnder);
  EXPECT_TRUE(bench.out.power) << "the axis holds as well as it can";
  bench.supply = 24;
  bench.temperature = 95;
  bench.run(0.2);
  EXPECT_EQ(bench.control.troubles(), Surroundings::kHot);
}

TEST(AxisControl, PowerGoesOnlyAfterAStopHasHadItsTime) {
  Bench hot;
  hot.control.set_power(true);
  hot.run(0.1);
  hot.temperature = 112;
  hot.run(1.9);
  EXPECT_EQ(hot.control.troubles(), Surroundings::kHot);
  EXPECT_TRUE(hot.out.power) << "all stop on the path, and hold";
  hot.run(0.2);
  EXPECT_EQ(hot.control.tripped(), fault::kTemperature);
  EXPECT_FALSE(hot.out.power);

  Bench high;
  high.control.set_power(true);
  high.run(0.1);
  high.supply = 35;
  high.run(0.008);
  EXPECT_EQ(high.control.troubles(), Surroundings::kOver);
  EXPECT_TRUE(high.out.power);
  high.run(0.004);
  EXPECT_EQ(high.control.tripped(), fault::kOverVoltage);
}

TEST(AxisControl, ABrokenSupplyDividerTakesThePowerAndIsNeverDividedBy) {
  for (const double reading : {0.0, -0.1, std::numeric_limits<double>::quiet_NaN()}) {
    Bench bench;
    bench.control.set_power(true);
    bench.run(0.3);
    ASSERT_TRUE(bench.out.power);
    const double before = std::hypot(bench.motor.ia, bench.motor.ib);
    EXPECT_GT(before, 0.5);
    bench.measured_supply = reading;
    int periods = 0;
    for (; periods < 100 && bench.control.tripped() == fault::kNone; ++periods) {
      bench.period();
      EXPECT_TRUE(std::isfinite(bench.out.duty.x) && std::isfinite(bench.out.duty.y));
      if (bench.out.power) {
        EXPECT_NEAR(std::hypot(bench.motor.ia, bench.motor.ib), before, 0.1 * before);
      }
    }
    EXPECT_LT(periods, 60) << "3 ms";
    EXPECT_EQ(bench.control.tripped(), fault::kUnderVoltage);
    EXPECT_FALSE(bench.out.power);
    // Nor does it get power again before there is a supply.
    bench.control.acknowledge();
    bench.run(0.01);
    EXPECT_FALSE(bench.out.power);
    bench.measured_supply.reset();
    bench.run(0.01);
    bench.control.acknowledge();
    bench.run(0.01);
    EXPECT_TRUE(bench.out.power);
  }
}

TEST(AxisControl, ABrokenTemperatureSensorIsToldAndDropsNothing) {
  for (const double reading : {-79.0, 374.0}) {
    Bench bench;
    bench.control.set_power(true);
    bench.temperature = reading;
    bench.run(3);
    EXPECT_EQ(bench.control.troubles(), Surroundings::kHot) << reading;
    EXPECT_TRUE(bench.out.power) << reading;
  }
}

TEST(AxisControl, BlockedMotorIsAFollowingErrorBothWays) {
  for (const int way : {1, -1}) {
    AxisConfig config = Bench::standard();
    config.encoder = EncoderMode::kWatch;
    Bench bench(config);
    bench.encoder_present = true;
    bench.control.set_power(true);
    bench.run(0.3);
    bench.motor.blocked = true;
    bench.velocity = way * 50'000;
    bench.run(0.05);
    EXPECT_EQ(bench.control.troubles(), Surroundings::kFollowing) << way;
    EXPECT_GT(way * bench.control.following_error(), 1024) << way;
  }
}

TEST(AxisControl, LoadIsTakenUpWithTheEncoder) {
  AxisConfig config = Bench::standard();
  config.encoder = EncoderMode::kClosedLoop;
  Bench bench(config);
  bench.encoder_present = true;
  bench.motor.friction = 3e-3;
  bench.control.set_power(true);
  bench.run(0.5);
  bench.motor.load = 0.05;
  bench.run(0.5);
  // Half a step of the encoder: 1.6 counts.
  EXPECT_LT(std::abs(bench.motor.counts()), 3.2);
}

TEST(AxisControl, ClosedLoopKeepsStepWhereOpenLoopLosesIt) {
  for (const bool closed : {false, true}) {
    AxisConfig config = Bench::standard();
    config.encoder = closed ? EncoderMode::kClosedLoop : EncoderMode::kWatch;
    Bench bench(config);
    bench.encoder_present = true;
    bench.motor.friction = 1e-3;
    bench.control.set_power(true);
    bench.run(0.3);
    bench.velocity = 60'000;
    bench.motor.load = 0.4;  // more than the motor has
    bench.run(0.03);
    bench.motor.load = 0;
    bench.run(0.1);
    bench.velocity = 0;
    bench.run(0.3);
    const double error = std::abs(bench.motor.counts() - bench.position);
    if (closed) {
      EXPECT_LT(error, 10) << "back in step";
    } else {
      EXPECT_GT(error, 500) << "the test's blow should make an open loop lose steps";
    }
  }
}

TEST(AxisControl, AutoTuneFindsResistanceAndInductance) {
  AxisConfig config = Bench::standard();
  config.motor = {1.0F, 1.0e-3F, 0};
  config.motor_measured = false;
  config.bandwidth_hz = 500;
  for (const auto& [resistance, inductance] : {std::pair{0.6, 0.9e-3}, {1.2, 2.2e-3}, {3.5, 8e-3}}) {
    Bench bench(config);
    bench.encoder_present = true;
    bench.encoder_zero = 0.3;
    bench.motor.resistance = resistance;
    bench.motor.inductance = inductance;
    bench.control.set_power(true);
    bench.run(0.3);
    bench.control.request_tune();
    bench.run(1.0);
    ASSERT_EQ(bench.control.tune_state(), AutoTune::State::kDone);
    EXPECT_NEAR(bench.control.tune_result().resistance_ohm, resistance, 0.03 * resistance);
    EXPECT_NEAR(bench.control.tune_result().inductance_h, inductance, 0.08 * inductance);
    EXPECT_EQ(bench.control.tripped(), fault::kNone);
    EXPECT_LT(std::abs(bench.motor.counts()), 2) << "the rotor stays while it is measured";
  }
}

}  // namespace
}  // namespace kinebus::motor
