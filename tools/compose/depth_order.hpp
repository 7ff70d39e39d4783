#pragma once
// Which of the triangles that face an eye hides which.

#include <array>
#include <string>
#include <vector>

#include "tools/compose/mesh.hpp"

namespace kinebus::compose {

struct Facet {
  std::array<Vector, 3> corners;
  Vector normal;  ///< length 1, towards the eye
  std::string colour;
};

/// From the farthest to the nearest, for an eye far away that all of them face. Those that reach through the
/// plane of another are cut there, so that each hides what comes before it and nothing else.
/// Cost: n log n where few are cut, n^2 for a round body.
std::vector<Facet> from_behind(std::vector<Facet> facets);

}  // namespace kinebus::compose
