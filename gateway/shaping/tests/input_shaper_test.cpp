// The shapers by their residual vibration curves, as their papers publish them.

#include "gateway/shaping/input_shaper.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinebus {
namespace {

constexpr ShaperKind kAll[] = {ShaperKind::kZv,   ShaperKind::kMzv,     ShaperKind::kZvd,
                               ShaperKind::kEi,   ShaperKind::kTwoHump, ShaperKind::kThreeHump,
                               ShaperKind::kZvdd, ShaperKind::kZvddd};

/// Largest residual over frequencies within `share` of the shaper's own.
double worst_within(ShaperKind kind, double share, double damping) {
  const InputShaper shaper = make_shaper(kind, 50, damping);
  double worst = 0;
  for (int i = -100; i <= 100; ++i)
    worst = std::max(worst, residual_vibration(shaper, 50 * (1 + share * i / 100), damping));
  return worst;
}

TEST(InputShaper, WeightsArePositiveWithSumOneAndTimesRise) {
  for (const ShaperKind kind : kAll)
    for (const double damping : {0.0, 0.05, 0.3}) {
      const InputShaper shaper = make_shaper(kind, 37, damping);
      double sum = 0, before = -1;
      for (const InputShaper::Pulse& p : shaper.all()) {
        EXPECT_GT(p.weight, 0);
        EXPECT_GT(p.time_s, before);
        before = p.time_s;
        sum += p.weight;
      }
      EXPECT_NEAR(sum, 1, 1e-15);
      EXPECT_EQ(shaper.all().front().time_s, 0);
    }
  const InputShaper none = make_shaper(ShaperKind::kNone, 0, 0);
  EXPECT_EQ(none.count, 1u);
  EXPECT_EQ(none.duration_s(), 0);
  EXPECT_EQ(residual_vibration(none, 40, 0), 1);
}

TEST(InputShaper, DurationsAreThePublishedShareOfThePeriod) {
  const std::pair<ShaperKind, double> table[] = {{ShaperKind::kZv, 0.5},      {ShaperKind::kMzv, 0.75},
                                                 {ShaperKind::kZvd, 1},       {ShaperKind::kEi, 1},
                                                 {ShaperKind::kTwoHump, 1.5}, {ShaperKind::kThreeHump, 2},
                                                 {ShaperKind::kZvdd, 1.5},    {ShaperKind::kZvddd, 2}};
  for (const auto& [kind, periods] : table) {
    EXPECT_NEAR(make_shaper(kind, 40, 0).duration_s(), periods / 40, 1e-12);
    EXPECT_NEAR(make_shaper(kind, 40, 0.2).duration_s(), periods / (40 * std::sqrt(0.96)), 1e-12);
  }
}

TEST(InputShaper, NothingIsLeftAtTheirOwnFrequencyOrTheToleranceThatTheyGive) {
  for (const double damping : {0.0, 0.05, 0.1, 0.2}) {
    for (const ShaperKind kind :
         {ShaperKind::kZv, ShaperKind::kMzv, ShaperKind::kZvd, ShaperKind::kZvdd, ShaperKind::kZvddd})
      EXPECT_NEAR(residual_vibration(make_shaper(kind, 50, damping), 50, damping), 0, 1e-12);
    for (const ShaperKind kind : {ShaperKind::kEi, ShaperKind::kTwoHump, ShaperKind::kThreeHump})
      EXPECT_LE(residual_vibration(make_shaper(kind, 50, damping), 50, damping), kShaperTolerance + 1e-12);
  }
  EXPECT_NEAR(residual_vibration(make_shaper(ShaperKind::kEi, 50, 0), 50, 0), kShaperTolerance, 1e-12);
}

TEST(InputShaper, UndampedCurvesAreTheClosedForms) {
  constexpr double pi = std::numbers::pi;
  for (double ratio = 0.3; ratio < 1.8; ratio += 0.05) {
    const double zv = std::abs(std::cos(0.5 * pi * ratio));
    EXPECT_NEAR(residual_vibration(make_shaper(ShaperKind::kZv, 50, 0), 50 * ratio, 0), zv, 1e-12);
    EXPECT_NEAR(residual_vibration(make_shaper(ShaperKind::kZvd, 50, 0), 50 * ratio, 0), zv * zv, 1e-12);
    EXPECT_NEAR(residual_vibration(make_shaper(ShaperKind::kZvdd, 50, 0), 50 * ratio, 0), std::pow(zv, 3),
                1e-12);
    EXPECT_NEAR(residual_vibration(make_shaper(ShaperKind::kZvddd, 50, 0), 50 * ratio, 0), std::pow(zv, 4),
                1e-12);
    const double ei = std::abs(0.5 * 1.05 * std::cos(pi * ratio) + 0.5 * 0.95);
    EXPECT_NEAR(residual_vibration(make_shaper(ShaperKind::kEi, 50, 0), 50 * ratio, 0), ei, 1e-12);
  }
}

TEST(InputShaper, FrequencyMayBeWrongByThePublishedShareForTwentyTimesLessVibration) {
  constexpr double tolerance = kShaperTolerance + 5e-4;
  EXPECT_LE(worst_within(ShaperKind::kMzv, 0.04, 0), tolerance);
  EXPECT_LE(worst_within(ShaperKind::kZvd, 0.14, 0), tolerance);
  EXPECT_LE(worst_within(ShaperKind::kEi, 0.19, 0), tolerance);
  EXPECT_LE(worst_within(ShaperKind::kTwoHump, 0.35, 0), tolerance);
  EXPECT_LE(worst_within(ShaperKind::kThreeHump, 0.45, 0), tolerance);
  EXPECT_GT(worst_within(ShaperKind::kZv, 0.10, 0), 0.15);
  EXPECT_GT(worst_within(ShaperKind::kMzv, 0.10, 0), tolerance);
  EXPECT_GT(worst_within(ShaperKind::kZvd, 0.20, 0), tolerance);
}

TEST(InputShaper, MadeForOverridesItLeavesLittleAtEachOfThem) {
  EXPECT_EQ(frequency_for_rates(ShaperKind::kEi, 45, 0.1, 1), 45);
  EXPECT_EQ(frequency_for_rates(ShaperKind::kEi, 45, 0.1, 0), 45);
  const auto worst = [](ShaperKind kind, double made_for_hz, double slowest) {
    const InputShaper shaper = make_shaper(kind, made_for_hz, 0.1);
    double most = 0;
    for (double rate = slowest; rate <= 1; rate += 0.01)
      for (const double error : {0.9, 0.95, 1.0, 1.05, 1.1})
        for (const double damping : {0.07, 0.13})
          most = std::max(most, residual_vibration(shaper, 45 * error / rate, damping));
    return most;
  };
  for (const ShaperKind kind : kAll) {
    const double made_for_hz = frequency_for_rates(kind, 45, 0.1, 0.5);
    EXPECT_GT(made_for_hz, 45);
    EXPECT_LT(worst(kind, made_for_hz, 0.5), worst(kind, 45, 0.5));
  }
  EXPECT_LE(worst(ShaperKind::kThreeHump, frequency_for_rates(ShaperKind::kThreeHump, 45, 0.1, 0.5), 0.5),
            0.05);
  EXPECT_LE(worst(ShaperKind::kTwoHump, frequency_for_rates(ShaperKind::kTwoHump, 45, 0.1, 0.7), 0.7), 0.05);
}

TEST(InputShaper, CornersLeaveThePathByThePublishedDistances) {
  // At 5000 mm/s^2 and 50 Hz.
  const auto corner_um = [](ShaperKind kind) {
    return 1000 * 0.5 * 5000 * make_shaper(kind, 50, 0).variance_s2();
  };
  EXPECT_NEAR(corner_um(ShaperKind::kZv), 62.5, 0.1);
  EXPECT_NEAR(corner_um(ShaperKind::kMzv), 82.4, 0.1);
  EXPECT_NEAR(corner_um(ShaperKind::kEi), 131.3, 0.1);
}

}  // namespace
}  // namespace kinebus
