#include "gateway/calibration/joint_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinebus {
namespace {

/// Second derivatives of the natural cubic spline through equidistant values (tridiagonal system, no pivoting
/// needed).
std::vector<double> natural_bends(const std::vector<double>& y, double h) {
  const std::size_t n = y.size();
  std::vector<double> m(n, 0.0), upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double d = 6 * (y[i - 1] - 2 * y[i] + y[i + 1]) / (h * h);
    const double pivot = 4 - upper[i - 1];
    upper[i] = 1 / pivot;
    m[i] = (d - m[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) m[i] -= upper[i] * m[i + 1];
  return m;
}

}  // namespace

JointMap::JointMap(const JointCalibration& c) {
  if (c.pitch > 0 && (c.periodic_sine != 0 || c.periodic_cosine != 0)) {
    wave_ = 2 * std::numbers::pi / c.pitch;
    sine_ = c.periodic_sine;
    cosine_ = c.periodic_cosine;
    const double amplitude = std::hypot(sine_, cosine_);
    slope_ = amplitude * wave_;
    curvature_ = slope_ * wave_;
    longest_step_ = c.pitch / 6;
  }
  if (c.table.size() < 2 || !(c.table_step > 0)) return;
  spline_ = {c.table_start, c.table_step, c.table, natural_bends(c.table, c.table_step)};
  longest_step_ = std::min(longest_step_, c.table_step / 2);
  double slope = 0, curvature = 0;
  for (std::size_t i = 0; i + 1 < spline_.value.size(); ++i) {
    // e'' is linear between knots, so e' differs from the chord by at most h/2 times the larger bend.
    const double bend = std::max(std::abs(spline_.bend[i]), std::abs(spline_.bend[i + 1]));
    slope = std::max(
        slope, std::abs(spline_.value[i + 1] - spline_.value[i]) / spline_.step + bend * spline_.step / 2);
    curvature = std::max(curvature, bend);
  }
  slope_ += slope;
  curvature_ += curvature;
}

JointMap::Value JointMap::Spline::at(double q) const {
  if (value.empty()) return {0, 0, 0};
  const double x = (q - start) / step, last = static_cast<double>(value.size() - 1);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(x), 0.0, last - 1));
  const double h = step, b = std::clamp(x - static_cast<double>(i), 0.0, 1.0), a = 1 - b;
  Value v;
  v.g = a * value[i] + b * value[i + 1] +
        ((a * a * a - a) * bend[i] + (b * b * b - b) * bend[i + 1]) * h * h / 6;
  v.g1 = (value[i + 1] - value[i]) / h + ((1 - 3 * a * a) * bend[i] + (3 * b * b - 1) * bend[i + 1]) * h / 6;
  v.g2 = a * bend[i] + b * bend[i + 1];
  // Straight on beyond the ends, where the natural spline does not bend.
  const double beyond = (x < 0 ? x : x > last ? x - last : 0.0) * h;
  v.g += beyond * v.g1;
  return v;
}

JointMap::Value JointMap::at(double q) const {
  Value e = spline_.at(q);
  if (wave_ > 0) {
    const double s = std::sin(wave_ * q), c = std::cos(wave_ * q);
    const double wave = sine_ * s + cosine_ * c;
    e.g += wave;
    e.g1 += wave_ * (sine_ * c - cosine_ * s);
    e.g2 -= wave_ * wave_ * wave;
  }
  return {q - e.g, 1 - e.g1, -e.g2};
}

double JointMap::to_joint(double drive) const {
  double q = drive;
  for (int k = 0; k < 20; ++k) {
    const Value v = at(q);
    const double step = (drive - v.g) / v.g1;
    q += step;
    if (std::abs(step) < 1e-12) break;
  }
  return q;
}

}  // namespace kinebus
