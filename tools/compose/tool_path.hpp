#pragma once
// Places of the tool's tip along one canonical move, part coordinates.

#include <Eigen/Geometry>

#include "gateway/gcode/canonical.hpp"
#include "tools/compose/mesh.hpp"

namespace kinebus::compose {

inline Vector tip_of(const Pose& pose) {
  return {pose[0], pose[1], pose[2]};
}

inline Vector centre_of(const canonical::Arc& arc) {
  return {arc.centre_mm[0], arc.centre_mm[1], arc.centre_mm[2]};
}

/// `arc`: nullptr for a straight move. `share`: 0 at `from`, 1 at `to`.
inline Vector tip_between(const Vector& from, const Vector& to, const canonical::Arc* arc, double share) {
  if (arc == nullptr) return from + share * (to - from);
  const Vector axis(arc->normal[0], arc->normal[1], arc->normal[2]);
  const Vector turned = Eigen::AngleAxisd(share * arc->sweep_rad, axis) * (from - centre_of(*arc));
  return centre_of(*arc) + turned + share * axis * axis.dot(to - from);
}

inline double length_of(const Vector& from, const Vector& to, const canonical::Arc* arc) {
  return arc != nullptr ? arc->sweep_rad * (from - centre_of(*arc)).norm() : (to - from).norm();
}

}  // namespace kinebus::compose
