// Spectra, springs and shapers from numbers whose truth is known.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tools/tune/acceleration_readings.hpp"
#include "tools/tune/shaper_choice.hpp"
#include "tools/tune/vibration_fit.hpp"

namespace kinebus {
namespace {

TEST(EnergySpectrum, IsTheEnergyOfASineInItsBandAlone) {
  // Parseval: a sine of amplitude 3 for 20 s has 90 in all, half of it at the positive frequency.
  std::vector<double> sine(20'000);
  for (std::size_t i = 0; i < sine.size(); ++i)
    sine[i] = 7 + 3 * std::sin(2 * std::numbers::pi * 40.25 * 1e-3 * static_cast<double>(i));
  const Bands bands{10, 0.5, 160};
  const std::vector<double> energy = energy_spectrum(sine, 1e-3, bands);
  double all = 0;
  for (const double e : energy) all += e;
  EXPECT_NEAR(all, 45, 0.5);
  EXPECT_GT(energy[60], 0.9 * all);
}

/// What a record of this machine would hold, with noise that is equal at all frequencies.
std::vector<double> measured(const Bands& bands, const std::vector<FittedMode>& modes, double noise,
                             std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> scatter(0, 0.05);
  std::vector<double> energy;
  for (std::size_t i = 0; i < bands.count; ++i) {
    const double t = transmissibility(modes, bands.middle_hz(i));
    energy.push_back((0.9 * t * t + noise) * std::exp(scatter(random)));
  }
  return energy;
}

TEST(VibrationFit, FindsFrequencyDampingAndASecondSpring) {
  const Bands bands{11, 0.5, 216};
  const std::vector<double> planned(bands.count, 1);
  std::mt19937_64 random(5);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 40; ++i) {
    const double f = between(25, 80), share = between(0.05, 0.2);
    const std::vector<FittedMode> truth{{f, between(0.02, 0.2), 1 - share},
                                        {between(2, 3) * f, between(0.03, 0.1), share}};
    const auto fit =
        fit_vibration(bands, planned, measured(bands, truth, 0.01, static_cast<std::uint64_t>(i)));
    ASSERT_TRUE(fit) << fit.error();
    EXPECT_NEAR(fit->modes[0].frequency_hz, truth[0].frequency_hz, 0.02 * truth[0].frequency_hz);
    EXPECT_NEAR(fit->modes[0].damping_ratio, truth[0].damping_ratio, 0.15 * truth[0].damping_ratio + 0.003);
  }
}

TEST(VibrationFit, SaysThatNothingSwings) {
  const Bands bands{11, 0.5, 216};
  const std::vector<double> planned(bands.count, 1);
  EXPECT_FALSE(fit_vibration(bands, planned, measured(bands, {{400, 0.1, 1}}, 0, 1)));
  EXPECT_FALSE(fit_vibration(bands, planned, std::vector<double>(bands.count, 0)));
}

TEST(ShaperChoice, TakesTheShortestThatLeavesLittle) {
  const ShaperQuestion one{.axes = {{{45, 0.1, 0.9}, {120, 0.06, 0.1}}},
                           .accel_mm_per_s2 = 3000,
                           .deviation_mm = 0.02,
                           .slowest_rate = 0};
  const auto ratings = rate_shapers(one);
  const ShaperRating& best = best_shaper(ratings);
  EXPECT_LE(best.left, kMostLeft);
  for (const ShaperRating& r : ratings)
    if (r.left <= kMostLeft) {
      EXPECT_GE(r.deviation_mm, best.deviation_mm);
    }
  // a / 2 times the variance is the deviation: both ways.
  EXPECT_NEAR(best.accel_mm_per_s2 / 3000, 0.02 / best.deviation_mm, 1e-9);
  // Directions far apart that share a shaper need a longer one, between them.
  const ShaperQuestion both{.axes = {{{40, 0.1, 1}}, {{60, 0.1, 1}}},
                            .accel_mm_per_s2 = 3000,
                            .deviation_mm = 0,
                            .slowest_rate = 0};
  const auto shared = rate_shapers(both);
  EXPECT_GT(best_shaper(shared).frequency_hz, 40);
  EXPECT_LT(best_shaper(shared).frequency_hz, 60);
  EXPECT_GT(best_shaper(shared).deviation_mm, best.deviation_mm);
  EXPECT_LE(best_shaper(shared).left, 0.06);
  // At lower overrides the same spring looks faster.
  const ShaperQuestion slowed{
      .axes = one.axes, .accel_mm_per_s2 = 3000, .deviation_mm = 0, .slowest_rate = 0.5};
  EXPECT_LE(best_shaper(rate_shapers(slowed)).left, 0.06);
}

TEST(AccelerationReadings, AreReadAndWhatIsWrongIsSaid) {
  std::string text = "#time,accel_x,accel_y,accel_z\n";
  for (int i = 0; i < 1200; ++i) text += std::to_string(5 + i * 0.001) + ",1.5,-2,9806\r\n";
  const auto read = read_acceleration(text);
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->mm_per_s2.size(), 1200u);
  EXPECT_NEAR(read->period_s, 1e-3, 1e-9);
  EXPECT_EQ(read->mm_per_s2[7], (std::array{1.5, -2.0, 9806.0}));
  const std::pair<std::string, const char*> wrong[] = {
      {"1,2,3\n", "1: expected four numbers"},         {"1,2,3,4,5\n", "1: expected four numbers"},
      {"1,2,3,nan\n", "1: expected four numbers"},     {"1,2,3,4\n1,2,3,4\n", "2: the time goes from"},
      {"1,2,3,4\n3,2,3,4\n", "2: the time goes from"}, {"1,2,3,4\n", "1 readings; expected at least 1000"}};
  for (const auto& [lines, words] : wrong) {
    const auto bad = read_acceleration(lines);
    ASSERT_FALSE(bad) << lines;
    EXPECT_EQ(bad.error().find(words), 0u) << bad.error();
  }
}

}  // namespace
}  // namespace kinebus
