#include "gateway/gcode/curves/nurbs.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus::gcode {
namespace {

using Point = Nurbs::Point;

/// How far p is from the straight line through a and b, or from a where they are one point.
double off_line(const Point& p, const Point& a, const Point& b) {
  double along = 0, length = 0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    along += (p[k] - a[k]) * (b[k] - a[k]);
    length += (b[k] - a[k]) * (b[k] - a[k]);
  }
  const double share = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0;
  double off = 0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const double d = p[k] - a[k] - share * (b[k] - a[k]);
    off += d * d;
  }
  return std::sqrt(off);
}

struct Flattener {
  const Nurbs& curve;
  double flatness_mm;
  std::size_t most;
  std::vector<Point>& ends;

  bool piece(double u, const Point& a, double v, const Point& b, int depth) {
    const double middle = (u + v) / 2;
    const Point m = curve.at(middle);
    // Three places: a curve that turns may cross its chord in the middle.
    const double off = std::max({off_line(m, a, b), off_line(curve.at(u + (v - u) / 4), a, b),
                                 off_line(curve.at(v - (v - u) / 4), a, b)});
    if (off <= flatness_mm || depth == 0) {
      if (ends.size() >= most) return false;
      ends.push_back(b);
      return true;
    }
    return piece(u, a, middle, m, depth - 1) && piece(middle, m, v, b, depth - 1);
  }
};

}  // namespace

bool Nurbs::is_clamped() const {
  const std::size_t n = knots.size();
  if (points.size() < order || n != points.size() + order) return false;
  if (knots[0] != knots[order - 1] || knots[n - order] != knots[n - 1]) return false;
  for (std::size_t i = 1; i + order < n; ++i)
    if (knots[i] == knots[i + order - 1]) return false;
  return knots[order - 1] < knots[n - order];
}

void Nurbs::set_even_knots() {
  knots.clear();
  for (std::size_t i = 0; i < points.size() + order; ++i)
    knots.push_back(static_cast<double>(std::clamp(i, order - 1, points.size()) - (order - 1)));
}

Point Nurbs::at(double u) const {
  // de Boor: the span of u, then means of its points, with the weight as a fifth coordinate.
  const auto last = knots.begin() + static_cast<std::ptrdiff_t>(points.size());
  const auto above = std::upper_bound(knots.begin() + static_cast<std::ptrdiff_t>(order), last, u);
  const std::size_t span = static_cast<std::size_t>(above - knots.begin()) - 1;
  std::array<std::array<double, 5>, kMostOrder> d{};
  for (std::size_t j = 0; j < order; ++j) {
    const std::size_t i = span + 1 - order + j;
    for (std::size_t k = 0; k < 4; ++k) d[j][k] = points[i][k] * weights[i];
    d[j][4] = weights[i];
  }
  for (std::size_t r = 1; r < order; ++r)
    for (std::size_t j = order - 1; j >= r; --j) {
      const std::size_t i = span + 1 - order + j;
      const double share = (u - knots[i]) / (knots[i + order - r] - knots[i]);
      for (std::size_t k = 0; k < 5; ++k) d[j][k] = d[j - 1][k] + share * (d[j][k] - d[j - 1][k]);
    }
  const auto& end = d[order - 1];
  return {end[0] / end[4], end[1] / end[4], end[2] / end[4], end[3] / end[4]};
}

bool flatten(const Nurbs& curve, double flatness_mm, std::size_t most, std::vector<Point>& ends) {
  constexpr int kDeepest = 24;
  Flattener flattener{curve, flatness_mm, most, ends};
  Point here = curve.points.front();
  for (std::size_t i = curve.order - 1; i < curve.points.size(); ++i) {
    const double u = curve.knots[i], v = curve.knots[i + 1];
    if (!(v > u)) continue;
    const bool end = i + 1 == curve.points.size();
    const Point there = end ? curve.points.back() : curve.at(v);
    if (!flattener.piece(u, here, v, there, kDeepest)) return false;
    here = there;
  }
  return true;
}

}  // namespace kinebus::gcode
