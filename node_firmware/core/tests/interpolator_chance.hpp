#pragma once
// What the tests of LinearInterpolator have in common: units, seeded chance, and the least time of a way.

#include <cmath>
#include <cstdint>
#include <random>

#include "node_firmware/core/linear_interpolator.hpp"

namespace kinebus::testing_way {
inline constexpr long double kTicks = 16e6L;

inline std::int64_t fixed(long double counts) {
  return static_cast<std::int64_t>(std::ldexp(counts, 32));
}
inline long double counts(std::int64_t position) {
  return std::ldexp(static_cast<long double>(position), -32);
}
inline long double counts_per_s(std::int64_t velocity) {
  return std::ldexp(static_cast<long double>(velocity), -56) * kTicks;
}

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : random_(seed) {}
  std::uint64_t of(std::uint64_t n) { return random_() % n; }
  double even() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double within(double low, double high) { return low * std::pow(high / low, even()); }
  int sign() { return of(2) == 0 ? 1 : -1; }

 private:
  std::mt19937_64 random_;
};

inline LinearInterpolator::Limits limits_of(Chance& chance, double least_ratio, double most_ratio) {
  LinearInterpolator::Limits limits;
  const double a = chance.within(1e4, 1e8);
  limits.profile = {static_cast<std::uint32_t>(chance.within(1000, 1.6e6)), static_cast<std::uint32_t>(a),
                    static_cast<std::uint32_t>(a * chance.within(least_ratio, most_ratio))};
  return limits;
}

/// The least time from rest to rest, s.
inline long double least_time(long double way, const ProfileLimits& limits) {
  const long double v = limits.velocity, a = limits.acceleration, d = limits.deceleration;
  const long double peak = std::sqrt(2 * way * a * d / (a + d));
  if (peak <= v) return peak / a + peak / d;
  return v / a + v / d + (way - v * v / 2 / a - v * v / 2 / d) / v;
}

}  // namespace kinebus::testing_way
