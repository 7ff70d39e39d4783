#pragma once
// What the composer asks of CGAL: reading and repairing meshes, closed cuts by a plane, union, volume.

#include <string>
#include <utility>
#include <vector>

#include "tools/compose/mesh.hpp"

namespace kinebus::compose {

/// What had to be mended on a mesh before it bounded a volume.
struct Repair {
  int duplicate_points = 0;  ///< points or faces merged or removed
  int holes_filled = 0;
  int self_intersections = 0;  ///< pairs of faces that crossed
  bool turned = false;         ///< normals pointed inward
  std::string words() const;
};

/// An STL or OBJ file (by its ending) as a closed mesh. Throws std::runtime_error naming file and reason: not
/// readable, no faces, not closable, still crossing itself after the repair.
std::pair<TriangleMesh, Repair> read_mesh(const std::string& path);

/// Closed mesh out of loose polygons; `what` names it in errors.
std::pair<TriangleMesh, Repair> close_mesh(const std::vector<Vector>& points,
                                           std::vector<std::vector<std::size_t>> polygons,
                                           const std::string& what);

struct Halves {
  TriangleMesh below, above;  ///< both closed; empty where nothing of the mesh is on that side
};
/// Cuts a closed mesh and closes both cuts.
Halves cut(const TriangleMesh& mesh, const Plane& plane);

/// Closed meshes into one. Throws std::runtime_error when the result is not a closed surface.
TriangleMesh unite(const TriangleMesh& a, const TriangleMesh& b);

double volume_mm3(const TriangleMesh& mesh);
/// The connected bodies of a mesh.
std::vector<TriangleMesh> bodies(const TriangleMesh& mesh);

}  // namespace kinebus::compose
