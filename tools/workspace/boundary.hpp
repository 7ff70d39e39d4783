#pragma once
// The workspace's surface as triangles, and as files that other programs read.

#include <array>
#include <iosfwd>
#include <vector>

#include "tools/workspace/scan.hpp"

namespace kinebus::workspace {

struct Triangle {
  std::array<std::array<float, 3>, 3> corner{};  ///< mm, counter-clockwise from outside
  float shade = 0;  ///< what the picture colours by: share of the tilts that the cell behind it allows, 0..1
};

/// A sector that is cut out so that one sees inside, rad from X; empty: nothing.
struct Sector {
  double from_rad = 0, to_rad = 0;
};

/// Faces between cells that are in and cells that are out. tilt < 0: in are the cells with any tilt allowed.
std::vector<Triangle> boundary(const Scan& scan, int tilt, Sector cut = {});

void write_stl(std::ostream& out, const std::vector<Triangle>& triangles);  ///< binary STL
void write_ply(std::ostream& out, const std::vector<Triangle>& triangles);  ///< text PLY with colours

}  // namespace kinebus::workspace
