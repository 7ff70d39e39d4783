#pragma once
// Logarithm and power for tables that are made when a sensor or a model is configured: the same bits on every
// platform, at compile time too. Software floating point on a chip without FPU; nothing that runs every tick
// uses it.

#include <cstdint>

namespace kinebus::heat {

/// x > 0. Error below 1e-15 relative to 1.
constexpr double natural_log(double x) {
  int doublings = 0;
  for (; x > 1.5; x /= 2) ++doublings;
  for (; x < 0.75; x *= 2) --doublings;
  const double z = (x - 1) / (x + 1), square = z * z;
  double term = z, sum = 0;
  for (int n = 1; n < 40; n += 2, term *= square) sum += term / n;
  return 2 * sum + doublings * 0.69314718055994530942;
}

/// |x| <= 500.
constexpr double exponential(double x) {
  constexpr double kHalf = 0.34657359027997265471;  // ln(2) / 2
  int doublings = 0;
  for (; x > kHalf; x -= 2 * kHalf) ++doublings;
  for (; x < -kHalf; x += 2 * kHalf) --doublings;
  double term = 1, sum = 1;
  for (int n = 1; n < 18; ++n) {
    term *= x / n;
    sum += term;
  }
  for (; doublings > 0; --doublings) sum *= 2;
  for (; doublings < 0; ++doublings) sum /= 2;
  return sum;
}

constexpr double square_root(double x) {
  if (x <= 0) return 0;
  double root = x > 1 ? x : 1;
  for (int i = 0; i < 64; ++i) root = (root + x / root) / 2;
  return root;
}

/// The nearest whole number of one that is not negative.
constexpr std::uint32_t nearest_whole(double value) {
  const double above = value + 0.5;
  return static_cast<std::uint32_t>(above);
}

}  // namespace kinebus::heat
