#include "node_firmware/motor/rest_trim.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinebus::motor {
namespace {

constexpr double kAngleOfCount = kAnglePerCount;

/// A rotor that friction holds within a band about where the current pulls it, seen by a coarse encoder.
struct StickingRotor {
  double friction = 1.5, pulled_aside = 0;  // counts
  double at = 0;

  void follow(double angle) {
    const double goal = angle + pulled_aside;
    at = std::clamp(at, goal - friction, goal + friction);
  }
  double encoder() const { return std::floor(at / 3.125) * 3.125; }
};

struct Settling {
  StickingRotor rotor;
  RestTrim rest;
  double trim = 0;          // counts
  double origin = 0;        // command less encoder, counts
  double largest_jump = 0;  // of the angle, in a control period
  double last_angle = 0;

  void run(int periods) {
    for (int i = 0; i < periods; ++i) {
      const auto error = static_cast<std::int32_t>((-origin - rotor.encoder()) * kAngleOfCount);
      const RestTrim::Step step = rest.step(error);
      trim += static_cast<double>(step.change) / kAngleOfCount;
      turn_to(trim + static_cast<double>(step.swing) / kAngleOfCount);
    }
  }
  void turn_to(double angle) {
    largest_jump = std::max(largest_jump, std::abs(angle - last_angle));
    last_angle = angle;
    rotor.follow(angle);
  }
};

constexpr int kWhole = RestTrim::kStillFrom * RestTrim::kSwingPeriods;

TEST(RestTrim, BringsTheRotorOnItsCommandThroughFrictionAndCoarseReadings) {
  for (double aside = -6; aside <= 6; aside += 0.37) {
    Settling s;
    s.rotor.pulled_aside = aside;
    // floor() shows the encoder half a step low in the mean.
    s.origin = 3.125 / 2;
    s.run(kWhole);
    EXPECT_NEAR(s.rotor.at, 0, 1.0) << aside << " counts aside";
  }
}

TEST(RestTrim, IsStillAfterwardsUntilTheRotorIsPushedAway) {
  Settling s;
  s.origin = 3.125 / 2;
  s.run(kWhole);
  s.run(1);
  const double rest = s.last_angle;
  s.run(2 * kWhole);
  EXPECT_EQ(s.last_angle, rest);
  s.rotor.pulled_aside = 10;
  s.run(2 * kWhole + RestTrim::kSwingPeriods);
  EXPECT_NEAR(s.rotor.at, 0, 1.0);
}

TEST(RestTrim, FadesWhenMotionBeginsInTheMiddleOfASwing) {
  Settling s;
  s.run(RestTrim::kSwingPeriods + RestTrim::kSwingPeriods / 4);
  EXPECT_GT(s.last_angle, RestTrim::kSwingCounts - 1);
  s.largest_jump = 0;
  for (int i = 0; i < RestTrim::kSwingPeriods; ++i)
    s.turn_to(s.trim + static_cast<double>(s.rest.leave()) / kAngleOfCount);
  EXPECT_EQ(s.last_angle, s.trim);
  EXPECT_LT(s.largest_jump, 0.05) << "counts in a control period";
}

}  // namespace
}  // namespace kinebus::motor
