#include "tools/drawing/faces.hpp"

#include <algorithm>

namespace kinebus::drawing {

void draw_faces(Document& document, std::vector<Face> faces, double seam) {
  std::stable_sort(faces.begin(), faces.end(),
                   [](const Face& a, const Face& b) { return a.depth < b.depth; });
  const auto group = document.group({.width = seam, .round = true});
  for (const Face& face : faces) document.polygon(face.corners, {.fill = face.colour, .stroke = face.colour});
}

}  // namespace kinebus::drawing
