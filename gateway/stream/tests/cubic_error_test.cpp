#include "gateway/stream/cubic_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace kinebus {
namespace {

TEST(CubicError, FindsTheExtremeThatDenseSamplingFinds) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int run = 0; run < 2000; ++run) {
    const double d0 = any(random), d1 = any(random), d2 = run % 5 == 0 ? 0 : any(random),
                 d3 = run % 7 == 0 ? 0 : any(random);
    const double x0 = any(random) * 2, x1 = x0 + std::abs(any(random)) * 3;
    double sampled = 0;
    for (int i = 0; i <= 500; ++i) {
      const double x = x0 + (x1 - x0) * i / 500;
      sampled = std::max(sampled, std::abs(d0 + x * (d1 + x * (d2 + x * d3))));
    }
    const Extreme e = extreme_of_cubic(d0, d1, d2, d3, x0, x1);
    EXPECT_GE(std::abs(e.value), sampled - 1e-12) << "run " << run;
    EXPECT_LE(std::abs(e.value), sampled + 1e-3) << "run " << run;
    EXPECT_NEAR(e.value, d0 + e.x * (d1 + e.x * (d2 + e.x * d3)), 1e-12);
  }
}

}  // namespace
}  // namespace kinebus
