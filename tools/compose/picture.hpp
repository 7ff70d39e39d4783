#pragma once
// The pieces as a person sees them: together, and taken apart along their print directions.

#include <string>
#include <vector>

#include "tools/compose/piece_frame.hpp"

namespace kinebus::compose {

struct DrawnPiece {
  TriangleMesh mesh;  ///< part coordinates
  PieceFrame frame;
  std::string caption;
};

/// An SVG, 1200 x 640.
std::string picture(const std::string& title, const std::vector<DrawnPiece>& pieces);

}  // namespace kinebus::compose
