#pragma once
// Cuts a part into pieces that print without support, each along its own direction.
//
// Arms that hang come off first: across the arm, so that their layers lie square to it, or as nearly as the
// machine tilts; an arm that bends comes off in several. What hangs otherwise (plates, corners that arms
// leave) is cut where least is left hanging.
//
// Every cut takes a whole half space off a body. The rest is printed first, so a piece always stands on a
// face that is complete, and everything printed before it from the same body lies below that face: the nozzle
// cannot meet it. (Pieces of a piece are checked by the nozzle sweep.)

#include <vector>

#include "tools/compose/nozzle.hpp"
#include "tools/compose/overhang.hpp"

namespace kinebus::compose {

struct DecomposeOptions {
  double max_overhang_rad = 0.7853981633974483;  ///< what prints without support, from the vertical wall
  double max_tilt_rad = 0.7853981633974483;  ///< of a print direction against z: what the machine can tilt
  double max_bend_rad =
      0.2;  ///< of an arm away from the normal of a piece's layers, at the piece's ends (11 deg)
  double allowed_mm2 = 3;  ///< hanging area of a piece that is let pass (bridged by the strand itself)
  int max_pieces = 24;
  Nozzle nozzle;  ///< must have room over the tilted table where a piece begins
  double table_radius_mm = 100;
};

/// Pieces in the order of printing; the first stands on the table. Hanging area that no cut within the limits
/// removes is left and told by overhang_mm2() and unheld_mm2() of the piece.
std::vector<Solid> decompose(const Solid& part, const DecomposeOptions& options);

/// The same with given planes, applied in their order, each to the body that stands on the table.
/// Throws std::runtime_error for a plane that cuts nothing off or tilts too far.
std::vector<Solid> decompose(const Solid& part, const std::vector<Plane>& planes,
                             const DecomposeOptions& options);

}  // namespace kinebus::compose
