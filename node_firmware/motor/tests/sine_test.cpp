#include "node_firmware/motor/sine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinebus::motor {
namespace {

TEST(Sine, ErrorIsBelowFiveMillionthsEverywhere) {
  double worst = 0;
  for (std::uint64_t angle = 0; angle < (std::uint64_t{1} << 32); angle += 65'521) {
    const double exact = static_cast<double>(angle) / 4294967296.0 * 2 * std::numbers::pi;
    const SineCosine got = sine_cosine(static_cast<Angle>(angle));
    worst = std::max({worst, std::abs(got.sine - std::sin(exact)), std::abs(got.cosine - std::cos(exact))});
  }
  EXPECT_LT(worst, 5e-6);
}

TEST(Sine, FourFullStepsAreOneElectricalTurn) {
  constexpr std::int64_t kCount = std::int64_t{1} << 32;
  EXPECT_EQ(angle_of(256 * kCount), 0x4000'0000u);
  EXPECT_EQ(angle_of(-256 * kCount), 0xC000'0000u);
  EXPECT_EQ(angle_of(1024 * kCount), 0u);
  EXPECT_EQ(angle_of(kCount / 2), 1u << 21);  // finer than a count inside
}

TEST(Sine, RadiansBecomeAngles) {
  EXPECT_NEAR(angle_from(static_cast<float>(std::numbers::pi / 2)), 0x4000'0000u, 0x400);
  EXPECT_NEAR(static_cast<std::int32_t>(angle_from(-0.1F)), -68'356'525, 0x400);
}

}  // namespace
}  // namespace kinebus::motor
