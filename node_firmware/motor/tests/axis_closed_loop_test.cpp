// The loop closed by the encoder: the rotor is brought to its command, and what would only disturb is left.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "node_firmware/motor/tests/motor_model.hpp"

namespace kinebus::motor {
namespace {

TEST(AxisClosedLoop, ASettledRotorComesBackToItsCommandToAPartOfAStepOfTheEncoder) {
  for (const double phase : {0.0, 0.2, 0.4, 0.6, 0.8})
    for (const double load : {0.0, 0.03}) {
      Bench bench(with(EncoderMode::kClosedLoop));
      bench.encoder_present = true;
      bench.encoder_zero = phase / 16384 * 2 * std::numbers::pi;
      bench.motor.friction = 3e-3;
      bench.motor.load = load;
      bench.control.set_power(true);
      bench.run(1.2);
      const double first = bench.motor.counts() - bench.position;
      bench.velocity = 5'000;
      bench.run(1.0);
      bench.velocity = 0;
      bench.run(1.0);
      EXPECT_NEAR(bench.motor.counts() - bench.position, first, 0.6)
          << phase << " of a step, " << load << " Nm";
    }
}

TEST(AxisClosedLoop, AnEncoderThatIsLostLeavesWhatHeldTheRotorAgainstItsLoad) {
  for (const double load : {0.08, -0.08}) {
    Bench bench(with(EncoderMode::kClosedLoop));
    bench.encoder_present = true;
    bench.motor.friction = 3e-3;
    bench.control.set_power(true);
    bench.run(0.8);
    bench.motor.load = load;
    bench.run(0.8);
    ASSERT_NEAR(bench.motor.counts(), 0, 4);
    bench.encoder_present = false;
    EXPECT_LT(bench.farthest(0, 0.5), 12) << load;
  }
}

TEST(AxisClosedLoop, ALoadIsTakenUpInSlowMotionBothWays) {
  for (const auto& [load, from_s] : {std::pair{0.08, 0.6}, {-0.08, 0.6}, {0.08, 0.25}}) {
    Bench bench(with(EncoderMode::kClosedLoop));
    bench.encoder_present = true;
    bench.motor.friction = 3e-3;
    bench.control.set_power(true);
    bench.run(from_s);
    bench.velocity = 6'000;
    bench.run(0.1);
    bench.motor.load = load;
    bench.run(0.4);
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
      bench.period();
      sum += bench.position - bench.motor.counts();
    }
    EXPECT_NEAR(sum / 2000, 0, 4) << load;
  }
}

/// More than 90 degrees electrical away there is less torque, not more: trimming would only push it over the
TEST(AxisClosedLoop, ARotorThatIsHeldFarAwayIsNotTrimmedAndComesBackWithoutIt) {
  for (const int way : {1, -1}) {
    Bench bench(with(EncoderMode::kClosedLoop));
    bench.encoder_present = true;
    bench.motor.friction = 3e-3;
    bench.control.set_power(true);
    bench.run(1.2);
    for (int i = 1; i <= 200; ++i) {
      bench.turn_to(way * 300.0 * i / 200);
      bench.period();
    }
    bench.motor.blocked = true;
    bench.run(0.5);
    bench.motor.blocked = false;
    double beyond = 0;
    for (int i = 0; i < 6000; ++i) {
      bench.period();
      beyond = std::min(beyond, way * bench.motor.counts());
    }
    EXPECT_GT(beyond, -130) << way;
    EXPECT_NEAR(bench.motor.counts(), 0, 1.5) << way;
  }
}

TEST(AxisClosedLoop, FastMotionIsNotTrimmed) {
  // What a fast rotor lags behind by is no error of its place at rest.
  Bench bench(with(EncoderMode::kClosedLoop));
  bench.encoder_present = true;
  bench.motor.friction = 2e-3;
  bench.control.set_power(true);
  bench.run(0.6);
  while (bench.velocity < 200'000) {
    bench.velocity += 200;
    bench.period();
  }
  bench.run(0.3);
  while (bench.velocity > 0) {
    bench.velocity -= 200;
    bench.period();
  }
  bench.velocity = 0;
  EXPECT_LT(bench.farthest(bench.position, 0.02), 5);
  bench.run(0.5);
  EXPECT_NEAR(bench.motor.counts(), bench.position, 4);
}

}  // namespace
}  // namespace kinebus::motor
