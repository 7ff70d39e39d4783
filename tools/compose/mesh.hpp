#pragma once
// Triangle meshes as the composer's parts hand them to each other: plain arrays, mm, normals outward.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace kinebus::compose {

using Vector = Eigen::Vector3d;

struct TriangleMesh {
  std::vector<Vector> points;                       ///< mm
  std::vector<std::array<std::uint32_t, 3>> faces;  ///< indices, counter-clockwise seen from outside
};

/// The half space {q : normal . q >= height}. `normal` is a unit vector.
struct Plane {
  Vector normal{0, 0, 1};
  double height = 0;
  double over(const Vector& q) const { return normal.dot(q) - height; }
};

struct Box {
  Vector low{0, 0, 0}, high{0, 0, 0};
};
Box bounds(const TriangleMesh& mesh);

/// Binary STL. Throws std::runtime_error when the file cannot be written.
void write_stl(const TriangleMesh& mesh, const std::string& path);

}  // namespace kinebus::compose
