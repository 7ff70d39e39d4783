#include "tools/calibrate/fit/rail_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "gateway/calibration/joint_map.hpp"

namespace kinebus {
namespace {

/// A rail measured forth and back every `step`, by a device with normal noise.
std::vector<RailSample> measure(const JointCalibration& truth, double noise, unsigned seed, double step = 5) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0, noise);
  const JointMap map(truth);
  std::vector<RailSample> out;
  for (const int direction : {1, -1})
    for (double d = 530; d <= 1030; d += step) {
      const double commanded = direction > 0 ? d : 1560 - d;
      // Homed at 1030 without calibration: there drive and joint agree.
      const double drive = map.to_drive(1030) + (commanded - 1030) * (1 + truth.scale);
      const double q = map.to_joint(drive - direction * truth.backlash / 2);
      out.push_back({commanded, q + 0.37 + (noise > 0 ? normal(engine) : 0), direction});
    }
  return out;
}

TEST(RailFit, ThePapersCorrectionFactorsAreRecovered) {
  const double factors[] = {-0.00025, -0.0003, 0.0014, 0.0001};
  unsigned seed = 1;
  for (const double factor : factors) {
    JointCalibration truth;
    truth.scale = factor;
    truth.backlash = 0.04;
    const RailFit fit = fit_rail(measure(truth, 0.01, seed++), {.anchor = 1030});
    EXPECT_NEAR(fit.calibration.scale, factor, 2e-5);
    EXPECT_LT(fit.scale_sigma, 1e-5);
    EXPECT_NEAR(fit.calibration.backlash, 0.04, 0.005);
    EXPECT_LT(fit.after_rms, 0.012);
  }
}

TEST(RailFit, PeriodicErrorAndTableAreFound) {
  JointCalibration truth;
  truth.scale = 0.002;
  truth.backlash = 0.1;
  truth.pitch = 10;
  truth.periodic_sine = 0.02;
  truth.periodic_cosine = -0.01;
  truth.table_start = 530;
  truth.table_step = 100;
  truth.table = {0, 0.03, -0.02, 0.04, 0.01, 0};
  const RailFit fit =
      fit_rail(measure(truth, 0.003, 7, 1.7), {.anchor = 1030, .pitch = 10, .table_points = 11});
  EXPECT_LT(fit.after_rms, 0.005);
  EXPECT_GT(fit.before_rms, 0.2);
  EXPECT_NEAR(fit.calibration.periodic_sine, 0.02, 0.001);
  EXPECT_NEAR(fit.calibration.periodic_cosine, -0.01, 0.001);
  EXPECT_NEAR(fit.calibration.backlash, 0.1, 0.002);
  // A machine with this calibration homes at 1030 and then stands where it says, over the whole travel.
  const JointMap found(fit.calibration), real(truth);
  double worst = 0;
  for (double q = 540; q < 1025; q += 0.9) {
    const double counts = (found.to_drive(q) - found.to_drive(1030)) / (1 + fit.calibration.scale);
    const double stands = real.to_joint(real.to_drive(1030) + counts * (1 + truth.scale));
    worst = std::max(worst, std::abs(stands - q));
  }
  EXPECT_LT(worst, 0.012);
}

TEST(RailFit, OutliersDoNotPull) {
  JointCalibration truth;
  truth.scale = 0.0014;
  auto samples = measure(truth, 0.005, 9);
  for (std::size_t i = 0; i < samples.size(); i += 20) samples[i].measured += 0.8;
  const RailFit fit = fit_rail(samples, {.anchor = 1030});
  EXPECT_NEAR(fit.calibration.scale, 0.0014, 2e-5);
  EXPECT_GE(fit.outliers, samples.size() / 20);
}

TEST(RailFit, OneDirectionSaysNothingOfBacklash) {
  JointCalibration truth;
  truth.scale = 0.001;
  truth.backlash = 0.1;
  auto samples = measure(truth, 0.001, 11);
  samples.resize(samples.size() / 2);
  const RailFit fit = fit_rail(samples, {.anchor = 1030});
  EXPECT_FALSE(fit.has_both_directions);
  EXPECT_EQ(fit.calibration.backlash, 0);
  EXPECT_NEAR(fit.calibration.scale, 0.001, 1e-5);
  const RailFit nothing = fit_rail({}, {});
  EXPECT_EQ(nothing.calibration.scale, 0);
}

}  // namespace
}  // namespace kinebus
