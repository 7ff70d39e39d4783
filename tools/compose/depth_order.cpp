#include "tools/compose/depth_order.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace kinebus::compose {
namespace {

// Far less than a pixel, far more than what a cut of a mesh leaves of rounding.
constexpr double kOnPlane_mm = 1e-4;
constexpr std::size_t kTried = 8;  // of the planes that may divide the rest

Plane plane_of(const Facet& facet) {
  return {facet.normal, facet.normal.dot(facet.corners[0])};
}

struct Sides {
  bool before = false, behind = false;
};

Sides sides_of(const Plane& plane, const Facet& facet) {
  Sides sides;
  for (const Vector& p : facet.corners) {
    sides.before = sides.before || plane.over(p) > kOnPlane_mm;
    sides.behind = sides.behind || plane.over(p) < -kOnPlane_mm;
  }
  return sides;
}

/// What of the facet is on one side of the plane (`sign` 1: before it) joins `to`.
void keep_side(const Plane& plane, const Facet& facet, double sign, std::vector<Facet>& to) {
  std::vector<Vector> outline;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector &a = facet.corners[i], &b = facet.corners[(i + 1) % 3];
    const double at_a = sign * plane.over(a), at_b = sign * plane.over(b);
    if (at_a >= -kOnPlane_mm) outline.push_back(a);
    if ((at_a > kOnPlane_mm && at_b < -kOnPlane_mm) || (at_a < -kOnPlane_mm && at_b > kOnPlane_mm))
      outline.push_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  for (std::size_t i = 2; i < outline.size(); ++i)
    to.push_back({{outline[0], outline[i - 1], outline[i]}, facet.normal, facet.colour});
}

/// The one whose plane cuts fewest of the others, of some that lie far from one another in the list.
std::size_t divider(const std::vector<Facet>& facets) {
  std::size_t best = 0, fewest = facets.size();
  const std::size_t step = std::max<std::size_t>(1, facets.size() / kTried);
  for (std::size_t i = 0; i < facets.size(); i += step) {
    const Plane plane = plane_of(facets[i]);
    const auto cut =
        static_cast<std::size_t>(std::count_if(facets.begin(), facets.end(), [&](const Facet& f) {
          const Sides sides = sides_of(plane, f);
          return sides.before && sides.behind;
        }));
    if (cut < fewest) best = i, fewest = cut;
  }
  return best;
}

}  // namespace

std::vector<Facet> from_behind(std::vector<Facet> facets) {
  if (facets.size() < 2) return facets;
  const Plane plane = plane_of(facets[divider(facets)]);
  std::vector<Facet> before, on, behind;
  for (Facet& facet : facets) {
    const Sides sides = sides_of(plane, facet);
    if (sides.before && sides.behind) {
      keep_side(plane, facet, 1, before);
      keep_side(plane, facet, -1, behind);
    } else {
      (sides.before ? before : sides.behind ? behind : on).push_back(std::move(facet));
    }
  }
  // The plane looks at the eye: nothing behind it hides what lies in it, or before.
  std::vector<Facet> ordered = from_behind(std::move(behind)), near = from_behind(std::move(before));
  ordered.insert(ordered.end(), std::make_move_iterator(on.begin()), std::make_move_iterator(on.end()));
  ordered.insert(ordered.end(), std::make_move_iterator(near.begin()), std::make_move_iterator(near.end()));
  return ordered;
}

}  // namespace kinebus::compose
