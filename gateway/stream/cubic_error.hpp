#pragma once
// How far a cubic gets from zero: the error of a quadratic against a cubic, exactly.

#include <algorithm>
#include <cmath>

#include "gateway/stream/both_axes.hpp"

namespace kinebus {

/// Where a cubic is farthest from zero, and its value there.
struct Extreme {
  double x = 0, value = 0;
};

/// The value of d0 + d1 x + d2 x^2 + d3 x^3 with the largest magnitude on [x0, x1]. Closed form: both ends
/// and the roots of the slope.
inline Extreme extreme_of_cubic(double d0, double d1, double d2, double d3, double x0, double x1) {
  const auto value = [=](double x) { return d0 + x * (d1 + x * (d2 + x * d3)); };
  Extreme worst{x0, value(x0)};
  const auto look_at = [&](double x) {
    const double v = value(x);
    if (std::abs(v) > std::abs(worst.value)) worst = {x, v};
  };
  look_at(x1);
  const double square = d2 * d2 - 3 * d1 * d3;
  if (square > 0) {
    // The two roots without cancellation; a root at infinity or 0/0 fails the comparisons.
    const double t = -(d2 + std::copysign(std::sqrt(square), d2));
    const double xa = t / (3 * d3), xb = d1 / t;
    if (xa > x0 && xa < x1) look_at(xa);
    if (xb > x0 && xb < x1) look_at(xb);
  }
  return worst;
}

/// An upper bound of the same for each of two cubics, by the Bernstein coefficients: no root, no division.
inline Both bound_of_cubics(Both d0, Both d1, Both d2, Both d3, double x0, double x1) {
  const double third = (x1 - x0) * (1.0 / 3);
  const Both b0 = d0 + x0 * (d1 + x0 * (d2 + x0 * d3)), b3 = d0 + x1 * (d1 + x1 * (d2 + x1 * d3));
  const Both b1 = b0 + third * (d1 + x0 * (2 * d2 + x0 * 3 * d3));
  const Both b2 = b3 - third * (d1 + x1 * (2 * d2 + x1 * 3 * d3));
  return greater(greater(magnitude(b0), magnitude(b3)), greater(magnitude(b1), magnitude(b2)));
}

}  // namespace kinebus
