#pragma once
// Every way in which M1's four legs close for given carriages: forward kinematics without a place to begin.

#include <array>
#include <vector>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus {

struct M1Assembly {
  Vector3 platform_mm{};   ///< p, machine frame
  double a_rad = 0;        ///< -pi .. pi
  double residual_mm = 0;  ///< largest of the four legs' length errors, by substitution
  /// Leg i's carriage stands on the side of the platform that the description states (`carriage`).
  std::array<bool, 4> as_described{};

  bool physical() const { return as_described[0] && as_described[1] && as_described[2] && as_described[3]; }
};

/// Every real assembly for carriage travels `joints[0..3]`, mm. Elimination: with A given, the differences of
/// the four closure equations are linear in p; put into the first they leave a trigonometric polynomial in A
/// of degree 6 or less. Its roots are eigenvalues of the companion matrix in z = e^(iA), each polished by
/// Newton on all four legs. Sorted: physical ones first, then by A. Empty: none, or the legs leave a motion
/// free (any A closes). Heap.
std::vector<M1Assembly> m1_assemblies(const M1Geometry& geometry, const JointVector& joints);

}  // namespace kinebus
