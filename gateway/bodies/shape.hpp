#pragma once
// Convex solids and the distance between two of them. A solid is a core (segment, box or cylinder) with a
// skin of constant thickness around it: a capsule is a segment with a skin.

#include <array>
#include <cmath>
#include <cstdint>

namespace kinebus::bodies {

struct Vec {
  double x = 0, y = 0, z = 0;
  friend constexpr Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec operator*(double k, const Vec& a) { return {k * a.x, k * a.y, k * a.z}; }
  constexpr Vec operator-() const { return {-x, -y, -z}; }
};
constexpr double dot(const Vec& a, const Vec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vec& a) {
  return std::sqrt(dot(a, a));
}

struct Shape {
  enum class Core : std::uint8_t { kSegment, kBox, kCylinder };
  Core core = Core::kSegment;
  Vec centre{};
  /// Half of the segment; halves of the box's three edges, at right angles; half of the cylinder's axis.
  std::array<Vec, 3> half{};
  Vec axis{0, 0, 1};         ///< of a cylinder, length 1
  double radius_mm = 0;      ///< of a cylinder
  double skin_mm = 0;        ///< around the core
  double core_reach_mm = 0;  ///< no point of the core is farther from the centre

  static Shape capsule(const Vec& from, const Vec& to, double radius_mm);
  static Shape box(const Vec& centre, const Vec& half_u, const Vec& half_v, const Vec& half_w);
  /// `from`, `to`: centres of its two ends, not the same.
  static Shape cylinder(const Vec& from, const Vec& to, double radius_mm);

  /// Moves a capsule.
  void span(const Vec& from, const Vec& to) {
    lay(from, to);
    core_reach_mm = norm(half[0]);
  }
  /// The same, and its length stays.
  void lay(const Vec& from, const Vec& to) {
    centre = 0.5 * (from + to);
    half[0] = 0.5 * (to - from);
  }
};

struct Parting {
  double mm = 0;
  Vec axis{};  ///< of length 1: across a plane with `b` below it and `a` above; 0 where solids overlap
};
/// Smallest distance of the two surfaces, mm. Two capsules: to rounding; else never more than the truth and
/// at most 1 um less, for solids up to some metres. Solids that overlap: 0 or less, which says that they do
/// and not how far. Those that are at least `enough_mm` apart: measured no further, the answer lies between
/// `enough_mm` and the truth. Allocates nothing.
Parting part(const Shape& a, const Shape& b, double enough_mm = HUGE_VAL);
inline double distance_mm(const Shape& a, const Shape& b) {
  return part(a, b).mm;
}

/// Distance of a point from the surface, mm; in the solid 0 or less, and not how deep. Exact.
double distance_mm(const Shape& shape, const Vec& point);

/// How far the solid reaches along `axis`, which has length 1. Two solids are at least as far apart as what
/// is left between both along any axis.
double reach_along(const Shape& shape, const Vec& axis);

/// Not more than distance_mm, from the spheres around both.
inline double least_distance_mm(const Shape& a, const Shape& b) {
  return norm(a.centre - b.centre) - a.core_reach_mm - b.core_reach_mm - a.skin_mm - b.skin_mm;
}

}  // namespace kinebus::bodies
