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

TEST(CubicError, BothAxesAreBoundFromAboveEachByItself) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> any(-1, 1);
  double tightest = 0;
  for (int run = 0; run < 2000; ++run) {
    Both d[4];
    for (Both& power : d) power = Both{any(random), 1e-3 * any(random)};
    const double x0 = any(random) * 2, x1 = x0 + std::abs(any(random)) * 3;
    const Both bound = bound_of_cubics(d[0], d[1], d[2], d[3], x0, x1);
    for (int axis = 0; axis < 2; ++axis) {
      const double most =
          std::abs(extreme_of_cubic(d[0][axis], d[1][axis], d[2][axis], d[3][axis], x0, x1).value);
      EXPECT_GE(bound[axis], most * (1 - 1e-12)) << "run " << run << " axis " << axis;
      EXPECT_LE(bound[axis], 20 * most) << "run " << run << " axis " << axis;
      tightest = std::max(tightest, most / bound[axis]);
    }
  }
  EXPECT_GT(tightest, 0.999);  // at an end of the stretch it is the value itself
}

TEST(CubicError, LanesAreWhatTheStandardFunctionsSay) {
  const Both a{-2, 3}, b{1, -4};
  EXPECT_EQ(lesser(a, b)[0], -2);
  EXPECT_EQ(lesser(a, b)[1], -4);
  EXPECT_EQ(greater(a, b)[0], 1);
  EXPECT_EQ(greater(a, b)[1], 3);
  EXPECT_EQ(magnitude(a)[0], 2);
  EXPECT_EQ(with_sign_of(both(5), a)[0], -5);
  EXPECT_EQ(with_sign_of(both(5), a)[1], 5);
  const Both held = clamped(a, both(-1), both(2));
  EXPECT_EQ(held[0], -1);
  EXPECT_EQ(held[1], 2);
  EXPECT_EQ(greatest(b), 1);
  EXPECT_TRUE(any(a < b) && any(b < a) && !all(a < b) && all(a == Both{-2, 3}) && !any(a != Both{-2, 3}));
}

}  // namespace
}  // namespace kinebus
