#pragma once
// Which way a piece grows, told from the meshes alone: how a check sees whether layers lie square to an arm.

#include "tools/compose/mesh.hpp"

namespace kinebus::compose {

struct MedialAxis {
  Vector along{0, 0, 1};  ///< unit vector, to the side of the layers' normal
  /// The piece belongs to an arm: its sections are of about one size. Else the axis means little.
  bool of_arm = false;
};

/// The line through the centres of the part's sections where the piece is, in the middle half of the piece's
/// length; the sections stand square to that line (found by repetition, from `normal` on). `part` may be the
/// piece itself; the whole part shows an arm where it is cut obliquely, too.
MedialAxis medial_axis(const TriangleMesh& part, const TriangleMesh& piece, const Vector& normal);

}  // namespace kinebus::compose
