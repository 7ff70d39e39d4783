#pragma once
// Pieces that were sliced elsewhere, and how they lie in the part: a small TOML file.
//
//     [[piece]]
//     gcode = "base.gcode"            # relative to this file
//     [[piece]]
//     gcode = "arm.gcode"
//     origin_mm = [12, 0, 30]         # of the piece's coordinates, in the part's
//     euler_deg = [90, 45, -90]       # G68.2 I J K: turns about Z, X', Z''
//     # or: normal = [0.7, 0, 0.7]    # the piece's z axis; its x axis as near the part's as can be
//     mesh = "arm.stl"                # in part coordinates, for the nozzle check; may be left out

#include <optional>
#include <string>
#include <vector>

#include "tools/compose/piece_frame.hpp"

namespace kinebus::compose {

struct DescribedPiece {
  std::string gcode_path, mesh_path;
  PieceFrame frame;
};

/// Throws std::runtime_error "FILE:line: ..." with the key, what was found and what is expected.
std::vector<DescribedPiece> read_job_description(const std::string& path);

/// The text of such a file; paths are written as they are.
std::string describe_job(const std::vector<DescribedPiece>& pieces);

}  // namespace kinebus::compose
