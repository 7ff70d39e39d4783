#pragma once
// The pieces as a person sees them: together, and taken apart along their print directions.

#include <array>
#include <string>
#include <vector>

#include "tools/compose/piece_frame.hpp"

namespace kinebus::compose {

struct DrawnPiece {
  TriangleMesh mesh;  ///< part coordinates
  PieceFrame frame;
  std::string caption;
};

/// Red, green, blue, 0..1: the same in all pictures of a part.
std::array<double, 3> piece_colour(std::size_t piece);
std::string piece_rgb(std::size_t piece, double light);  ///< "#5c7a9e", of 1: as it is, less: darker

/// An SVG, 1200 x 640.
std::string picture(const std::string& title, const std::vector<DrawnPiece>& pieces);

}  // namespace kinebus::compose
