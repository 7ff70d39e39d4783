#include "tools/compose/depth_order.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace kinebus::compose {
namespace {

const Vector kToEye(0, 0, 1);

/// How near to the eye the facet is over (x, y); nothing where it is not there, or at its edge.
double height_over(const Facet& facet, double x, double y, double edge) {
  std::array<double, 3> weights{};
  const auto& c = facet.corners;
  const double area = (c[1] - c[0]).cross(c[2] - c[0]).z();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector &a = c[(i + 1) % 3], &b = c[(i + 2) % 3];
    weights[i] = ((a.x() - x) * (b.y() - y) - (b.x() - x) * (a.y() - y)) / area;
    if (!(weights[i] > edge)) return -std::numeric_limits<double>::infinity();
  }
  return weights[0] * c[0].z() + weights[1] * c[1].z() + weights[2] * c[2].z();
}

TEST(DepthOrder, WhatIsDrawnLastIsWhatIsNearest) {
  constexpr unsigned kSeed = 20;
  constexpr int kFacets = 40, kLooks = 4000;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> place(-50, 50);
  std::vector<Facet> facets;
  while (facets.size() < kFacets) {
    Facet facet;
    for (Vector& corner : facet.corners) corner = Vector(place(random), place(random), place(random));
    facet.normal =
        (facet.corners[1] - facet.corners[0]).cross(facet.corners[2] - facet.corners[0]).normalized();
    if (facet.normal.dot(kToEye) < 0.05) continue;
    facet.colour = std::to_string(facets.size());
    facets.push_back(facet);
  }
  const std::vector<Facet> ordered = from_behind(facets);
  int met = 0;
  for (int look = 0; look < kLooks; ++look) {
    const double x = place(random), y = place(random);
    std::string nearest, drawn;
    double highest = -std::numeric_limits<double>::infinity();
    for (const Facet& facet : facets)
      if (const double z = height_over(facet, x, y, 1e-3); z > highest) highest = z, nearest = facet.colour;
    // An edge of a cut is no edge of the facet: what is left out there is seen beside it.
    bool sure = std::isfinite(highest);
    for (const Facet& facet : facets) {
      const double z = height_over(facet, x, y, -1e-3);
      sure = sure && (facet.colour == nearest || z < highest - 0.1);
    }
    if (!sure) continue;
    for (const Facet& facet : ordered)
      if (std::isfinite(height_over(facet, x, y, -1e-9))) drawn = facet.colour;
    ++met;
    EXPECT_EQ(drawn, nearest) << "seed " << kSeed << ", at " << x << ", " << y;
  }
  EXPECT_GT(met, kLooks / 4);
}

TEST(DepthOrder, ThreeThatHideOneAnotherInARingAreCut) {
  // Each lies over the next at one end, and under the one before at the other.
  std::vector<Facet> facets;
  for (int i = 0; i < 3; ++i) {
    const Eigen::AngleAxisd turn(i * 2 * std::numbers::pi / 3, Vector(0, 0, 1));
    Facet facet{{turn * Vector(-20, -6, 5), turn * Vector(20, -6, -5), turn * Vector(20, -3, -5)}, {}, "x"};
    facet.normal =
        (facet.corners[1] - facet.corners[0]).cross(facet.corners[2] - facet.corners[0]).normalized();
    facets.push_back(facet);
  }
  EXPECT_GT(from_behind(facets).size(), 3u);
}

TEST(DepthOrder, NothingIsLost) {
  EXPECT_TRUE(from_behind({}).empty());
  const Facet one{{Vector(0, 0, 0), Vector(1, 0, 0), Vector(0, 1, 0)}, {0, 0, 1}, "one"};
  // The same twice: both lie in one plane.
  EXPECT_EQ(from_behind({one, one}).size(), 2u);
}

}  // namespace
}  // namespace kinebus::compose
