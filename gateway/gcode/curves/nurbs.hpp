#pragma once
// Rational B-splines (NURBS), as G5.2 and G6.2 state them, to lines.

#include <array>
#include <cstddef>
#include <vector>

namespace kinebus::gcode {

/// How far lines may leave the spline that they stand for: below the blending tolerance of every machine,
/// which rounds their corners again.
inline constexpr double kSplineFlatness_mm = 0.002;

/// Control points with weights over a clamped knot vector: the curve begins in the first point and ends in
/// the last (Piegl and Tiller, The NURBS Book, 4.2).
struct Nurbs {
  static constexpr std::size_t kMostPoints = 20'000;
  static constexpr std::size_t kLeastOrder = 2, kMostOrder = 10;
  using Point = std::array<double, 4>;  ///< X Y Z E, mm

  std::size_t order = 3;  ///< degree + 1
  std::vector<Point> points;
  std::vector<double> weights;  ///< > 0, one for each point
  std::vector<double> knots;    ///< one for each point, and `order` more; they do not fall

  /// The first and the last `order` knots are equal, and none between them stands `order` times, where the
  /// curve would be torn.
  bool is_clamped() const;
  /// Knots at even steps, for the points as they are. Needs at least `order` points.
  void set_even_knots();
  /// u within the knots. Cost: order^2 additions, no heap.
  Point at(double u) const;
};

/// Ends of lines that leave the curve by at most `flatness_mm` (in X Y Z E), the curve's end included, its
/// beginning not. `curve` is clamped. False: more than `most` would be needed.
bool flatten(const Nurbs& curve, double flatness_mm, std::size_t most, std::vector<Nurbs::Point>& ends);

}  // namespace kinebus::gcode
