// Distances against an independent search: points all over the surface of one solid, and the exact distance
// of a point to the other.

#include "gateway/bodies/shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>
#include <vector>

namespace kinebus::bodies {
namespace {

using Core = Shape::Core;

/// Exact distance of a point to the core, 0 inside.
double to_core(const Shape& s, const Vec& point) {
  const Vec r = point - s.centre;
  if (s.core == Core::kCylinder) {
    const double along = dot(r, s.axis), across = norm(r - along * s.axis);
    return std::hypot(std::max(std::abs(along) - norm(s.half[0]), 0.0), std::max(across - s.radius_mm, 0.0));
  }
  Vec rest = r;
  for (std::size_t k = 0; k < (s.core == Core::kBox ? 3u : 1u); ++k) {
    const double hh = dot(s.half[k], s.half[k]);
    if (hh > 0) rest = rest - std::clamp(dot(r, s.half[k]) / hh, -1.0, 1.0) * s.half[k];
  }
  return norm(rest);
}

/// Point of the core for three parameters in 0 .. 1; the core's whole surface is among them.
Vec on_core(const Shape& s, double u, double v, int face) {
  const double a = 2 * u - 1, b = 2 * v - 1;
  if (s.core == Core::kSegment) return s.centre + a * s.half[0];
  if (s.core == Core::kBox) {
    const auto k = static_cast<std::size_t>(face % 3);
    const double side = face < 3 ? 1 : -1;
    return s.centre + side * s.half[k] + a * s.half[(k + 1) % 3] + b * s.half[(k + 2) % 3];
  }
  const Vec any = std::abs(s.axis.x) < 0.7 ? Vec{1, 0, 0} : Vec{0, 1, 0};
  Vec e = cross(s.axis, any);
  e = (1 / norm(e)) * e;
  const Vec f = cross(s.axis, e);
  const double angle = 2 * std::numbers::pi * u;
  const Vec outwards = s.radius_mm * (std::cos(angle) * e + std::sin(angle) * f);
  if (face % 3 == 0) return s.centre + b * s.half[0] + outwards;
  return s.centre + (face % 3 == 1 ? 1.0 : -1.0) * s.half[0] + v * outwards;
}

/// Smallest distance found, by a coarse look over all of the surface and finer ones around its best place.
/// Never less than the truth.
double searched(const Shape& a, const Shape& b) {
  double best = HUGE_VAL;
  const int faces = a.core == Core::kBox ? 6 : a.core == Core::kCylinder ? 3 : 1;
  for (int face = 0; face < faces; ++face) {
    double u0 = 0.5, v0 = 0.5, width = 0.5, least = HUGE_VAL;
    for (int round = 0; round < 40; ++round) {
      const int steps = round == 0 ? 24 : 3;
      double best_u = u0, best_v = v0;
      for (int i = -steps; i <= steps; ++i)
        for (int k = -steps; k <= steps; ++k) {
          const double u = std::clamp(u0 + width * i / steps, a.core == Core::kCylinder ? -1.0 : 0.0,
                                      a.core == Core::kCylinder ? 2.0 : 1.0),
                       v = std::clamp(v0 + width * k / steps, 0.0, 1.0);
          const double d = to_core(b, on_core(a, u, v, face));
          if (d < least) {
            least = d;
            best_u = u;
            best_v = v;
          }
        }
      u0 = best_u;
      v0 = best_v;
      width *= round == 0 ? 0.1 : 0.6;
    }
    best = std::min(best, least);
  }
  return best - a.skin_mm - b.skin_mm;
}

class Random {
 public:
  explicit Random(std::uint32_t seed) : source_(seed) {}
  double in(double low, double high) { return std::uniform_real_distribution<>(low, high)(source_); }
  Vec direction() {
    for (;;) {
      const Vec v{in(-1, 1), in(-1, 1), in(-1, 1)};
      const double n = norm(v);
      if (n > 0.1 && n < 1) return (1 / n) * v;
    }
  }
  Shape shape(Core core) {
    const Vec centre = in(0, 400) * direction();
    const Vec d = direction();
    Vec e = cross(d, direction());
    e = (1 / norm(e)) * e;
    switch (core) {
      case Core::kSegment: {
        const Vec h = in(0, 400) * d;
        return Shape::capsule(centre - h, centre + h, in(0, 20));
      }
      case Core::kBox:
        return Shape::box(centre, in(1, 150) * d, in(1, 150) * e, in(1, 150) * cross(d, e));
      case Core::kCylinder:
        break;
    }
    const Vec h = in(1, 200) * d;
    return Shape::cylinder(centre - h, centre + h, in(1, 150));
  }

 private:
  std::mt19937 source_;
};

TEST(ShapeDistance, IsThatOfSearchedSurfacesForEveryTwoCores) {
  int apart = 0;
  for (std::uint32_t seed = 1; seed <= 150; ++seed) {
    Random random(seed);
    const auto core = [&](std::uint32_t n) { return static_cast<Core>(n % 3); };
    const Shape a = random.shape(core(seed)), b = random.shape(core(seed / 3));
    const double d = distance_mm(a, b);
    EXPECT_LE(least_distance_mm(a, b), d + 1e-9) << "seed " << seed;
    const double found = std::min(searched(a, b), searched(b, a));
    if (d + a.skin_mm + b.skin_mm <= 0) {
      // Cores overlap: one's surface reaches into the other, or it lies in it wholly.
      EXPECT_LT(found + a.skin_mm + b.skin_mm, 1e-2) << "seed " << seed;
      continue;
    }
    ++apart;
    const Vec axis = part(a, b).axis;
    EXPECT_NEAR(-reach_along(a, -axis) - reach_along(b, axis), d, 1e-6) << "seed " << seed;
    const Vec any = random.direction();
    EXPECT_LE(-reach_along(a, -any) - reach_along(b, any), d + 2e-3) << "seed " << seed;
    EXPECT_LE(d, found + 1e-9) << "seed " << seed;
    EXPECT_GT(d, found - 0.01) << "seed " << seed;
  }
  EXPECT_GT(apart, 80);
}

TEST(ShapeDistance, IsSymmetric) {
  for (std::uint32_t seed = 1; seed <= 2000; ++seed) {
    Random random(seed);
    const Shape a = random.shape(static_cast<Core>(seed % 3)),
                b = random.shape(static_cast<Core>(seed / 3 % 3));
    EXPECT_NEAR(std::max(distance_mm(a, b), 0.0), std::max(distance_mm(b, a), 0.0), 2e-3) << "seed " << seed;
  }
}

TEST(ShapeDistance, MeasuredNoFurtherThanEnoughIsBetweenThatAndTheTruth) {
  int cut = 0;
  for (std::uint32_t seed = 1; seed <= 2000; ++seed) {
    Random random(seed);
    const Shape a = random.shape(static_cast<Core>(seed % 3)),
                b = random.shape(static_cast<Core>(seed / 3 % 3));
    const double d = distance_mm(a, b);
    for (const double share : {0.3, 0.9, 1.5}) {
      const double enough = std::abs(d) * share, found = part(a, b, enough).mm;
      if (d < enough) {
        EXPECT_DOUBLE_EQ(found, d) << "seed " << seed;
        continue;
      }
      EXPECT_GE(found, enough) << "seed " << seed;
      EXPECT_LE(found, d + 1e-9) << "seed " << seed;
      cut += found < 0.95 * d ? 1 : 0;
    }
  }
  EXPECT_GT(cut, 100) << "it never ended early";
}

TEST(ShapeDistance, OfKnownPlacements) {
  const Shape rod = Shape::capsule({0, 0, 0}, {0, 0, 100}, 5),
              other = Shape::capsule({30, 0, 0}, {30, 0, 100}, 5);
  EXPECT_DOUBLE_EQ(distance_mm(rod, other), 20);
  EXPECT_DOUBLE_EQ(distance_mm(rod, Shape::capsule({20, -50, 50}, {20, 50, 50}, 3)), 12);
  EXPECT_DOUBLE_EQ(distance_mm(rod, Shape::capsule({0, 0, 130}, {0, 0, 130}, 5)), 20);
  EXPECT_DOUBLE_EQ(distance_mm(Shape::capsule({}, {}, 1), Shape::capsule({3, 4, 0}, {3, 4, 0}, 1)), 3);
  const Shape disc = Shape::cylinder({0, 0, -8}, {0, 0, 0}, 100);
  EXPECT_NEAR(distance_mm(disc, Shape::capsule({0, 0, 20}, {0, 0, 80}, 5)), 15, 1e-3);
  EXPECT_NEAR(distance_mm(disc, Shape::capsule({150, 0, -50}, {150, 0, 50}, 5)), 45, 1e-3);
  const Shape box = Shape::box({0, 0, 50}, {10, 0, 0}, {0, 20, 0}, {0, 0, 30});
  EXPECT_NEAR(distance_mm(disc, box), 20, 1e-3);
  EXPECT_LE(distance_mm(disc, Shape::box({0, 0, 10}, {10, 0, 0}, {0, 20, 0}, {0, 0, 30})), 0);
  EXPECT_LE(distance_mm(rod, rod), 0);
}

}  // namespace
}  // namespace kinebus::bodies
