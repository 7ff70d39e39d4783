#include "gateway/kinematics/bed_mesh.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace kinebus {
namespace {

constexpr double kSolved_mm = 1e-12;

/// Slopes, by the step, of the natural cubic spline through n values; values[stride * i].
std::vector<double> spline_slopes(const std::vector<double>& values) {
  // 2 m0 + m1 = 3 (f1 - f0); m(i-1) + 4 m(i) + m(i+1) = 3 (f(i+1) - f(i-1)); the same at the end.
  const std::size_t n = values.size();
  std::vector<double> upper(n), slope(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i > 0 ? 1 : 0, after = i + 1 < n ? 1 : 0;
    const double right = 3 * (values[std::min(i + 1, n - 1)] - values[i > 0 ? i - 1 : 0]);
    const double divisor = 2 * (before + after) - before * (i > 0 ? upper[i - 1] : 0);
    upper[i] = after / divisor;
    slope[i] = (right - before * (i > 0 ? slope[i - 1] : 0)) / divisor;
  }
  for (std::size_t i = n - 1; i-- > 0;) slope[i] -= upper[i] * slope[i + 1];
  return slope;
}

/// 1 at and below the bed, 0 from the fade's height on, two derivatives continuous.
struct Fade {
  double v = 1, d = 0, dd = 0;
  Fade(double z_mm, double height_mm) {
    if (!(height_mm > 0) || z_mm <= 0) return;
    const double t = z_mm / height_mm;
    v = t >= 1 ? 0 : 1 - t * t * t * (10 - t * (15 - 6 * t));
    d = t >= 1 ? 0 : -30 * t * t * (1 - t) * (1 - t) / height_mm;
    dd = t >= 1 ? 0 : -60 * t * (1 - t) * (1 - 2 * t) / (height_mm * height_mm);
  }
};

}  // namespace

bool MeshGrid::complete() const {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (points[axis] < 2 || points[axis] > kMostPoints) return false;
    if (!std::isfinite(from_mm[axis]) || !std::isfinite(to_mm[axis])) return false;
    if (!(to_mm[axis] > from_mm[axis])) return false;
  }
  if (!std::isfinite(fade_mm) || fade_mm < 0) return false;
  if (height_mm.size() != static_cast<std::size_t>(points[0]) * static_cast<std::size_t>(points[1]))
    return false;
  return std::all_of(height_mm.begin(), height_mm.end(), [](float h) { return std::isfinite(h); });
}

double MeshGrid::lowest_mm() const {
  return height_mm.empty() ? 0 : double{*std::min_element(height_mm.begin(), height_mm.end())};
}
double MeshGrid::highest_mm() const {
  return height_mm.empty() ? 0 : double{*std::max_element(height_mm.begin(), height_mm.end())};
}

/// A place along one axis: the interval of the grid, and the weights of both ends' values and slopes.
struct BedMesh::Place {
  std::size_t interval = 0;
  std::array<double, 2> value{}, value1{}, value2{};  ///< and their derivatives by the coordinate, mm
  std::array<double, 2> slope{}, slope1{}, slope2{};
};

BedMesh::BedMesh(MeshGrid grid) : grid_(std::move(grid)) {
  assert(grid_.complete());
  const auto columns = static_cast<std::size_t>(grid_.points[0]);
  const auto rows = static_cast<std::size_t>(grid_.points[1]);
  for (std::size_t axis = 0; axis < 2; ++axis)
    step_mm_[axis] = (grid_.to_mm[axis] - grid_.from_mm[axis]) / (grid_.points[axis] - 1);
  knots_.resize(columns * rows);
  for (std::size_t i = 0; i < knots_.size(); ++i) knots_[i].f = double{grid_.height_mm[i]};
  std::vector<double> line(columns);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < columns; ++i) line[i] = knots_[row * columns + i].f;
    const std::vector<double> slopes = spline_slopes(line);
    for (std::size_t i = 0; i < columns; ++i) knots_[row * columns + i].fx = slopes[i];
  }
  line.resize(rows);
  for (std::size_t column = 0; column < columns; ++column) {
    const auto along = [&](double Knot::*from, double Knot::*to) {
      for (std::size_t i = 0; i < rows; ++i) line[i] = knots_[i * columns + column].*from;
      const std::vector<double> slopes = spline_slopes(line);
      for (std::size_t i = 0; i < rows; ++i) knots_[i * columns + column].*to = slopes[i];
    };
    along(&Knot::f, &Knot::fy);
    along(&Knot::fx, &Knot::fxy);
  }
}

BedMesh::Place BedMesh::place(int axis, double at_mm) const {
  const auto a = static_cast<std::size_t>(axis);
  const int last = grid_.points[a] - 1;
  // In steps of the grid. Behind its border the coordinate comes to rest half a step farther on: its slope
  // falls from 1 to 0 over one step, as 1 - 3 t^2 + 2 t^3.
  double at = (at_mm - grid_.from_mm[a]) / step_mm_[a], rate = 1 / step_mm_[a], bend = 0;
  const double beyond = at < 0 ? -at : at - last;
  if (beyond > 0) {
    const double t = std::min(beyond, 1.0), sign = at < 0 ? -1 : 1;
    at = (at < 0 ? 0 : last) + sign * t * (1 - t * t * (1 - 0.5 * t));
    bend = sign * -6 * t * (1 - t) * rate * rate;
    rate *= 1 - t * t * (3 - 2 * t);
  }
  Place p;
  p.interval = static_cast<std::size_t>(std::clamp(static_cast<int>(std::floor(at)), 0, last - 1));
  const double t = at - static_cast<double>(p.interval);
  std::array<double, 2> value{1, 0}, value1{}, value2{}, slope{}, slope1{}, slope2{};
  if (t < 0) {  // straight on, where the spline has no curvature
    slope = {t, 0};
    slope1 = {1, 0};
  } else if (t > 1) {
    value = {0, 1};
    slope = {0, t - 1};
    slope1 = {0, 1};
  } else {
    value = {1 - t * t * (3 - 2 * t), t * t * (3 - 2 * t)};
    value1 = {-6 * t * (1 - t), 6 * t * (1 - t)};
    value2 = {12 * t - 6, 6 - 12 * t};
    slope = {t * (1 - t) * (1 - t), -t * t * (1 - t)};
    slope1 = {(1 - t) * (1 - 3 * t), t * (3 * t - 2)};
    slope2 = {6 * t - 4, 6 * t - 2};
  }
  p.value = value;
  p.slope = slope;
  for (std::size_t i = 0; i < 2; ++i) {
    p.value1[i] = value1[i] * rate;
    p.value2[i] = value2[i] * rate * rate + value1[i] * bend;
    p.slope1[i] = slope1[i] * rate;
    p.slope2[i] = slope2[i] * rate * rate + slope1[i] * bend;
  }
  return p;
}

BedMesh::Lift BedMesh::lift(double x_mm, double y_mm, double z_mm) const {
  Lift all;
  if (!acts_at(z_mm)) return all;
  const Place x = place(0, x_mm), y = place(1, y_mm);
  const auto columns = static_cast<std::size_t>(grid_.points[0]);
  double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (std::size_t j = 0; j < 2; ++j) {
    double f = 0, f1 = 0, f2 = 0, g = 0, g1 = 0, g2 = 0;  // of the heights along X, and of their slopes by Y
    for (std::size_t i = 0; i < 2; ++i) {
      const Knot& k = knots_[(y.interval + j) * columns + x.interval + i];
      f += k.f * x.value[i] + k.fx * x.slope[i];
      f1 += k.f * x.value1[i] + k.fx * x.slope1[i];
      f2 += k.f * x.value2[i] + k.fx * x.slope2[i];
      g += k.fy * x.value[i] + k.fxy * x.slope[i];
      g1 += k.fy * x.value1[i] + k.fxy * x.slope1[i];
      g2 += k.fy * x.value2[i] + k.fxy * x.slope2[i];
    }
    s += f * y.value[j] + g * y.slope[j];
    sx += f1 * y.value[j] + g1 * y.slope[j];
    sxx += f2 * y.value[j] + g2 * y.slope[j];
    sy += f * y.value1[j] + g * y.slope1[j];
    sxy += f1 * y.value1[j] + g1 * y.slope1[j];
    syy += f * y.value2[j] + g * y.slope2[j];
  }
  const Fade fade(z_mm, grid_.fade_mm);
  all = {.v = s * fade.v,
         .x = sx * fade.v,
         .y = sy * fade.v,
         .z = s * fade.d,
         .xx = sxx * fade.v,
         .xy = sxy * fade.v,
         .yy = syy * fade.v,
         .xz = sx * fade.d,
         .yz = sy * fade.d,
         .zz = s * fade.dd};
  return all;
}

double BedMesh::height_below(double x_mm, double y_mm, double above_mm) const {
  double z = above_mm;
  // The lift's slope by z stays below 1 / 2 (kLeastFade): each step leaves less than a third of the error.
  for (int i = 0; i < 60; ++i) {
    const Lift l = lift(x_mm, y_mm, z);
    const double step = (z + l.v - above_mm) / (1 + l.z);
    z -= step;
    if (std::abs(step) < kSolved_mm) break;
  }
  return z;
}

}  // namespace kinebus
