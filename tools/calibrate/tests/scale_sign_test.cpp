// `scale` of a machine file is a measured error; what a controller is given to apply has the other sign.

#include <gtest/gtest.h>

#include <vector>

#include "gateway/stream/axis_scaling.hpp"
#include "tools/calibrate/fit/rail_fit.hpp"

namespace kinebus {
namespace {

TEST(ScaleSign, ThePapersCorrectionsTakeOutErrorsOfTheOtherSign) {
  // Paper M5's corrections to apply, rails 1-4.
  for (const double correction : {-0.00025, -0.0003, 0.0014, 0.0001}) {
    // A rail that goes as far as it is told once it is told (1 + correction) times as far.
    const auto travel = [&](double told_mm) { return told_mm / (1 + correction); };
    std::vector<RailSample> samples;
    for (int mm = 0; mm <= 500; mm += 10)
      for (const int direction : {1, -1}) samples.push_back({static_cast<double>(mm), travel(mm), direction});
    const double scale = fit_rail(samples, {}).calibration.scale;
    EXPECT_EQ(scale<0, correction> 0);
    EXPECT_NEAR(scale, -correction, 3e-6);
    // With the fitted scale in the file, the gateway tells the rail's motor what brings it to 300 mm.
    AxisScaling axis;
    axis.scale_correction = scale;
    const double told_mm = axis.to_counts(300) / axis.counts_per_unit;
    EXPECT_NEAR(told_mm / 300 - 1, correction, 1e-9);
    EXPECT_NEAR(travel(told_mm), 300, 1e-6);
  }
}

}  // namespace
}  // namespace kinebus
