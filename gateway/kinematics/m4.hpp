#pragma once
// The planar mechanism of M4 by itself, in the plane of its paper: x across, y up, phi from x towards y.
// Rails 1 and 2 stand at x = -rails/2 and +rails/2, rods lead from their blocks to the corners A and B of an
// equilateral triangle; corner C's height is the third input. P is the middle of AB.

#include <vector>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus {

/// Pose of the triangle: P in mm, phi in rad.
struct PlanarPose {
  double x_mm = 0, y_mm = 0, phi_rad = 0;
};

/// One way in which the mechanism closes for given inputs.
struct M4Assembly {
  PlanarPose pose;
  /// Largest of: both rods' length errors and C's height error, by substitution, mm.
  double residual_mm = 0;
  /// The triangle with C on the other side of AB: satisfies the same rod lengths, but is another triangle.
  bool mirrored = false;
  std::array<bool, 2> block_above{};  ///< blocks 1 and 2 stand above corners A and B

  /// What the machine that was built can take: its own triangle, both blocks above.
  bool physical() const { return !mirrored && block_above[0] && block_above[1]; }
};

/// Every real assembly for inputs y1, y2, y3 (mm). Elimination: the two rod equations are quadratics in x
/// whose resultant (2 x 2 Bezout determinant) is a polynomial of degree 8 in tan(phi / 2); its real roots,
/// found as eigenvalues of the companion matrix, are polished by Newton. Sorted: physical ones first. Heap.
std::vector<M4Assembly> m4_assemblies(const M4Geometry& geometry, const Vector3& inputs_mm);

/// Newton from `pose`, on the true triangle. Returns the residual as above; `pose` moves there when that is
/// below 1e-9 mm, else it stays.
double m4_newton(const M4Geometry& geometry, const Vector3& inputs_mm, PlanarPose& pose);

/// Inputs for a pose, blocks above the tool. Error kOutOfReach: joint 0 or 1, mm that its rod is too short.
Result<Vector3, PoseError> m4_inputs(const M4Geometry& geometry, const PlanarPose& pose);

}  // namespace kinebus
