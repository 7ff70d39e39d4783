// What the control makes of its encoder: where the rotor is taken to be, and what is told as lost.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "node_firmware/motor/tests/motor_model.hpp"

namespace kinebus::motor {
namespace {

TEST(AxisEncoder, ARotorThatIsDrawnToItsFirstAngleIsOnItsCommandThen) {
  for (const EncoderMode mode : {EncoderMode::kWatch, EncoderMode::kClosedLoop})
    for (const double stands : {230.0, -230.0, 90.0}) {
      Bench bench(with(mode));
      bench.encoder_present = true;
      bench.turn_to(stands);
      bench.run(0.005);
      bench.control.set_power(true);
      for (int i = 0; i < 10; ++i) {
        bench.run(0.05);
        EXPECT_EQ(bench.control.troubles(), 0) << stands;
      }
      EXPECT_LT(std::abs(bench.control.following_error()), 6) << stands;
      EXPECT_NEAR(bench.motor.counts(), bench.position, 6) << stands;
    }
}

TEST(AxisEncoder, StepsThatAreLostAtRestAreToldAndStayTold) {
  for (const int turns : {1, -1}) {
    Bench bench(with(EncoderMode::kWatch));
    bench.encoder_present = true;
    bench.control.set_power(true);
    bench.run(0.5);
    ASSERT_LT(std::abs(bench.control.following_error()), 6);
    // By hand, a little at a time, so that the encoder sees all of it.
    for (int i = 1; i <= 400; ++i) {
      bench.turn_to(turns * 1024.0 * i / 400);
      bench.period();
    }
    bench.run(1.0);
    EXPECT_NEAR(bench.control.following_error(), -turns * 1024, 8);
  }
}

TEST(AxisEncoder, StepsThatAreLostBeforeTheRotorWasEverSeenAtRestAreToldToo) {
  Bench bench(with(EncoderMode::kWatch));
  bench.encoder_present = true;
  bench.control.set_power(true);
  bench.run(0.16);  // drawn, and not yet looked at for a window
  for (int i = 1; i <= 100; ++i) {
    bench.turn_to(1024.0 * i / 100);
    bench.period();
  }
  bench.run(1.0);
  EXPECT_NEAR(bench.control.following_error(), -1024, 8);
}

TEST(AxisEncoder, AMotionSoonAfterPowerIsWatchedFromItsFirstMillimetre) {
  for (const bool blocked : {false, true}) {
    AxisConfig config = with(EncoderMode::kWatch);
    config.following_periods = 20;
    Bench bench(config);
    bench.encoder_present = true;
    bench.control.set_power(true);
    bench.run(0.03);
    bench.motor.blocked = blocked;
    for (int i = 0; i < 200; ++i) {
      bench.velocity += 100;
      bench.period();
    }
    bench.run(0.15);
    EXPECT_EQ(bench.control.troubles(), blocked ? Surroundings::kFollowing : 0);
    if (!blocked) {
      EXPECT_LT(std::abs(bench.control.following_error()), 40);
    }
  }
}

/// A rotor that hardly anything damps swings while its first place is taken: what is told later is of the
/// mean.
TEST(AxisEncoder, ASwingingRotorsPlaceIsTheMiddleOfItsSwings) {
  for (const double stands : {230.0, -120.0, 60.0, -250.0})
    for (const double from_s : {0.03, 0.06, 0.3}) {
      Bench bench(with(EncoderMode::kWatch));
      bench.encoder_present = true;
      bench.motor.friction = 1e-4;
      bench.turn_to(stands);
      bench.run(0.005);
      bench.control.set_power(true);
      bench.run(from_s);
      for (int i = 0; i < 200; ++i) {
        bench.velocity += 100;
        bench.period();
      }
      bench.run(0.2);
      for (int i = 0; i < 20; ++i) {
        bench.run(0.01);
        EXPECT_NEAR(bench.control.following_error(), 0, 3) << stands << " from " << from_s << " s on";
      }
      // What it lags behind by from now on is told, in motion as at rest.
      bench.motor.load = 0.08;
      bench.run(0.3);
      for (int i = 0; i < 20; ++i) {
        bench.run(0.01);
        EXPECT_NEAR(bench.control.following_error(), bench.position - bench.motor.counts(), 4) << stands;
        EXPECT_NEAR(bench.control.following_error(), 60, 5) << stands;
      }
      bench.motor.load = 0;
      bench.velocity = 0;
      bench.run(0.5);
      EXPECT_NEAR(bench.control.following_error(), 0, 4) << stands;
      bench.motor.load = 0.08;
      bench.run(1.0);
      EXPECT_NEAR(bench.control.following_error(), bench.position - bench.motor.counts(), 4) << "at rest";
      EXPECT_GT(bench.control.following_error(), 80) << "the hold current is less";
    }
}

TEST(AxisEncoder, APlaceTakenAtRestIsTheMiddleOfSwings) {
  for (const double stands : {230.0, -230.0, 250.0}) {
    Bench bench(with(EncoderMode::kWatch));
    bench.encoder_present = true;
    bench.motor.friction = 1e-6;
    bench.motor.inertia = 40e-6;  // with what it moves
    bench.turn_to(stands);
    bench.run(0.005);
    bench.control.set_power(true);
    bench.run(1.5);
    double sum = 0, command = 0;
    for (int i = 0; i < 4000; ++i) {
      bench.period();
      sum += bench.control.following_error();
      command += bench.position - bench.motor.counts();
    }
    EXPECT_NEAR(sum / 4000, command / 4000, 4) << stands;
  }
}

TEST(AxisEncoder, AStepThatIsLostAsTheFirstMotionBeginsIsTold) {
  for (const int turns : {1, -1}) {
    Bench bench(with(EncoderMode::kWatch));
    bench.encoder_present = true;
    bench.control.set_power(true);
    bench.run(0.1);
    bench.velocity = 20'000;
    bench.run(0.001);
    for (int i = 1; i <= 100; ++i) {
      bench.turn_to(bench.position + turns * 1024.0 * i / 100);
      bench.period();
    }
    bench.run(0.5);
    EXPECT_NEAR(bench.control.following_error(), -turns * 1024, 10);
    bench.velocity = 0;
    bench.run(0.5);
    EXPECT_NEAR(bench.control.following_error(), -turns * 1024, 10);
  }
}

TEST(AxisEncoder, AnEncoderThatDoesNotAnswerTellsNoFirstAngle) {
  AxisConfig config = with(EncoderMode::kClosedLoop);
  config.encoder_offset = 300;
  Bench bench(config);
  bench.run(0.005);
  bench.control.set_power(true);
  EXPECT_LT(bench.farthest(0, 0.3), 2);
  EXPECT_EQ(bench.control.troubles(), Surroundings::kEncoder);
}

TEST(AxisEncoder, WithoutPowerNothingIsLeftBehind) {
  AxisConfig config = with(EncoderMode::kWatch);
  config.following_periods = 20;
  Bench bench(config);
  bench.encoder_present = true;
  bench.control.set_power(true);
  bench.run(0.5);
  bench.control.set_power(false);
  bench.run(0.001);
  for (int i = 1; i <= 400; ++i) {
    bench.turn_to(3000.0 * i / 400);
    bench.period();
    EXPECT_EQ(bench.control.following_error(), 0);
  }
  bench.run(0.1);
  EXPECT_EQ(bench.control.troubles(), 0);
}

TEST(AxisEncoder, AMirroredEncoderCountsWithTheMotor) {
  AxisConfig config = with(EncoderMode::kClosedLoop);
  config.encoder_reversed = true;
  Bench bench(config);
  bench.encoder_present = bench.encoder_mirrored = true;
  bench.control.set_power(true);
  bench.run(0.3);
  bench.velocity = 30'000;
  bench.run(0.5);
  EXPECT_EQ(bench.control.troubles(), 0);
  EXPECT_NEAR(bench.motor.counts(), bench.position, 60);
  EXPECT_LT(std::abs(bench.control.following_error()), 60);
}

TEST(AxisEncoder, AFollowingErrorLastsAsLongAsIsAllowedBeforeItIsTold) {
  for (const int periods : {20, 2000}) {
    AxisConfig config = with(EncoderMode::kWatch);
    config.following_periods = periods;
    Bench bench(config);
    bench.encoder_present = true;
    bench.control.set_power(true);
    bench.run(0.3);
    bench.motor.blocked = true;
    bench.velocity = 100'000;
    int until_off = 0, until_told = 0;
    while (std::abs(bench.control.following_error()) <= config.following_window && until_off < 10'000) {
      bench.period();
      ++until_off;
    }
    while (bench.control.troubles() == 0 && until_told < 10'000) {
      bench.period();
      ++until_told;
    }
    EXPECT_NEAR(until_told, periods, 2);
    EXPECT_NEAR(until_off, 1024 / 5, 4) << "5 counts a period";
  }
}

TEST(AxisEncoder, TurnedByHandWithoutPowerItStaysWhereItWasLeft) {
  AxisConfig config = with(EncoderMode::kWatch);
  config.encoder_offset = 0;
  Bench bench(config);
  bench.encoder_present = true;
  bench.control.set_power(true);
  bench.run(0.4);
  for (const double left : {310.0, -150.0, 1500.0}) {
    bench.control.set_power(false);
    bench.run(0.01);
    const double from = bench.motor.counts();
    for (int i = 1; i <= 400; ++i) {
      bench.turn_to(from + (left - from) * i / 400);
      bench.period();
    }
    bench.run(0.01);
    bench.control.set_power(true);
    EXPECT_LT(bench.farthest(left, 0.4), 8) << left;
    EXPECT_EQ(bench.control.troubles(), 0) << left;
    EXPECT_LT(std::abs(bench.control.following_error()), 8) << "the command is where it was left";
  }
}

TEST(AxisEncoder, PowerThatComesBackFindsNoTrimOfALoadThatHasGone) {
  AxisConfig config = with(EncoderMode::kClosedLoop);
  config.encoder_offset = 0;
  Bench bench(config);
  bench.encoder_present = true;
  bench.motor.friction = 3e-3;
  bench.control.set_power(true);
  bench.run(0.5);
  bench.motor.load = 0.1;
  bench.run(0.6);
  ASSERT_NEAR(bench.motor.counts(), 0, 4) << "the trim holds it against the load";
  bench.control.set_power(false);
  bench.run(0.001);
  bench.motor.load = 0;
  bench.turn_to(0);
  bench.run(0.01);
  bench.control.set_power(true);
  EXPECT_LT(bench.farthest(0, 0.1), 8);
}

/// goal.
TEST(AxisEncoder, NoEncoderHasNoZeroToBeFound) {
  Bench bench(with(EncoderMode::kWatch));
  bench.control.set_power(true);
  bench.run(0.3);
  bench.control.request_tune();
  bench.run(1.0);
  ASSERT_EQ(bench.control.tune_state(), AutoTune::State::kDone);
  EXPECT_EQ(bench.control.tuned_encoder_offset(), -1);
}

TEST(AxisEncoder, TheZeroIsTheSameWhereverItIsMeasured) {
  for (const double at : {0.0, 130.0, 300.0, 700.0, -420.0}) {
    Bench bench(with(EncoderMode::kWatch));
    bench.encoder_present = true;
    bench.encoder_zero = 0.3;
    bench.position = at;
    bench.turn_to(at);
    bench.control.set_power(true);
    bench.run(0.4);
    bench.control.request_tune();
    bench.run(1.0);
    ASSERT_EQ(bench.control.tune_state(), AutoTune::State::kDone);
    EXPECT_NEAR(bench.control.tuned_encoder_offset(), std::fmod(0.3 / (2 * std::numbers::pi) * 51'200, 1024),
                6)
        << at;
  }
}

}  // namespace
}  // namespace kinebus::motor
