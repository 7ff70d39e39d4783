#pragma once
// Huber's weights: readings far from the rest pull less. The scale comes from the readings themselves.

#include <algorithm>
#include <cmath>
#include <vector>

namespace kinebus {

/// 1.4826 times the median of |residuals|: the standard deviation of normal noise, whatever outliers do.
inline double robust_sigma(std::vector<double> residuals) {
  if (residuals.empty()) return 0;
  for (double& r : residuals) r = std::abs(r);
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return 1.4826 * *middle;
}

/// Within so many sigma a residual counts in full.
inline constexpr double kHuberBound = 2;

/// Weight of a residual: 1 within the bound, then falling as 1 / |r|.
inline double huber_weight(double residual, double sigma) {
  const double bound = kHuberBound * sigma, r = std::abs(residual);
  return r <= bound || !(r > 0) ? 1 : bound / r;
}

inline double rms_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace kinebus
