#pragma once
// Bodies seen from one side: triangles that hide one another, drawn from the farthest to the nearest.

#include <array>
#include <string>
#include <vector>

#include "tools/drawing/document.hpp"

namespace kinebus::drawing {

struct Face {
  std::array<Point, 3> corners{};  ///< px
  double depth = 0;                ///< towards the eye; of its middle
  std::string colour;
};

/// `seam`: px, drawn around each face in its own colour, so that no line of the ground shows between
/// neighbours.
void draw_faces(Document& document, std::vector<Face> faces, double seam);

}  // namespace kinebus::drawing
