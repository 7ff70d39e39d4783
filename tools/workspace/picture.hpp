#pragma once
// The workspace as one picture (SVG): the body cut open, a section, and what is left at each tilt.

#include <string>

#include "tools/workspace/scan.hpp"

namespace kinebus::workspace {

struct PictureText {
  std::string title, subtitle;
  double table_radius_mm = 0;  ///< that the cylinder shown stands on; 0: as wide as the room
};

/// `fine`: for section and curves; `coarse`: the same room with larger cells, for the body.
std::string draw_workspace(const Scan& fine, const Scan& coarse, const PictureText& text);

}  // namespace kinebus::workspace
