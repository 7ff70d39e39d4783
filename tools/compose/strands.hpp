#pragma once
// What a job lays down, as strands in part coordinates, in the order of printing.

#include <array>
#include <cstdint>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "tools/compose/joiner.hpp"
#include "tools/compose/mesh.hpp"

namespace kinebus::compose {

struct Strand {
  Vector from{0, 0, 0}, to{0, 0, 0};  ///< part coordinates, mm
  double a_rad = 0, c_rad = 0;        ///< of the table while it is laid
  int piece = 0, layer = 0;           ///< layers count from 0 in each piece
  bool outside = false;               ///< outer wall or visible face, by the slicer's comments
};

/// Arcs become chords of at most 1 mm. Without the slicer's comments every strand counts as outside.
std::vector<Strand> strands_of(const JoinedJob& job, const MachineDescription& machine);

}  // namespace kinebus::compose
