#pragma once
// Which way a piece grows, told from its mesh alone: how a check sees whether layers lie square to an arm.

#include "tools/compose/mesh.hpp"

namespace kinebus::compose {

/// Angle between `normal` (a unit vector) and the line through the centres of the piece's sections across it,
/// rad. The sections stand in the middle half of the piece's height, away from cut and tip. 0: layers along
/// `normal` lie square to the arm. Of a piece that is no arm it tells how far its middle wanders.
double angle_to_medial_axis(const TriangleMesh& mesh, const Vector& normal);

}  // namespace kinebus::compose
