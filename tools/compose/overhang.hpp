#pragma once
// Which faces of a body hang over when it is printed along a direction, and how much of them lies on either
// side of a cut.

#include <vector>

#include "tools/compose/mesh.hpp"

namespace kinebus::compose {

/// A body and how it is printed: along `base.normal`, standing on the plane `base`.
struct Solid {
  TriangleMesh mesh;
  Plane base;
};

/// A face counts as hanging when it leans out more than `limit_rad` from the wall (0: vertical wall, pi/2:
/// ceiling), unless it lies on the base. Slack: 0.5 deg for tessellated surfaces.
class Overhang {
 public:
  Overhang(const TriangleMesh& mesh, double limit_rad);

  /// Faces that hang over when printed along `up`. Faces on `base` are exempt (nullptr: none is).
  std::vector<bool> hanging(const Vector& up, const Plane* base) const;
  double area_mm2(const std::vector<bool>& faces) const;
  /// Area of these faces on the positive side of the plane, mm^2.
  double area_over(const std::vector<bool>& faces, const Plane& plane) const;

  const std::vector<Vector>& normals() const { return normals_; }
  const std::vector<double>& areas() const { return areas_; }

 private:
  const TriangleMesh& mesh_;
  double limit_sin_;
  std::vector<Vector> normals_;
  std::vector<double> areas_;
};

/// Overhanging area of a body on its base, mm^2.
double overhang_mm2(const Solid& solid, double limit_rad);

}  // namespace kinebus::compose
