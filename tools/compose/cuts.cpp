#include "tools/compose/cuts.hpp"

#include <algorithm>

#include "tools/compose/mesh_kernel.hpp"

namespace kinebus::compose {
namespace {

/// A plane is laid this far under the corner that it is to cut at: no sliver is left hanging.
constexpr double kUnderCornerMm = 0.02;
constexpr double kSmallestPieceMm3 = 10;
constexpr std::size_t kHeightsPerDirection = 40;

/// Every body of the mesh reaches down to the base: nothing would be printed into the air.
bool stands(const TriangleMesh& mesh, const Plane& base) {
  for (const TriangleMesh& body : bodies(mesh)) {
    double lowest = 1e300;
    for (const Vector& p : body.points) lowest = std::min(lowest, base.over(p));
    if (lowest > 0.05) return false;
  }
  return true;
}

}  // namespace

std::vector<double> heights(const TriangleMesh& mesh, const std::vector<bool>& hanging, const Vector& n) {
  std::vector<double> all;
  for (std::size_t i = 0; i < hanging.size(); ++i)
    if (hanging[i])
      for (const std::uint32_t corner : mesh.faces[i]) all.push_back(n.dot(mesh.points[corner]));
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end(), [](double a, double b) { return b - a < 0.01; }), all.end());
  std::vector<double> out;
  const std::size_t step = all.size() / kHeightsPerDirection + 1;
  for (std::size_t i = 0; i < all.size(); i += step) out.push_back(all[i] - kUnderCornerMm);
  return out;
}

std::optional<Parts> take_off(const Solid& solid, const Plane& plane) {
  Halves halves = cut(solid.mesh, plane);
  if (volume_mm3(halves.above) < kSmallestPieceMm3 || volume_mm3(halves.below) < kSmallestPieceMm3) return {};
  if (!stands(halves.above, plane) || !stands(halves.below, solid.base)) return {};
  return Parts{{std::move(halves.below), solid.base}, {std::move(halves.above), plane}};
}

bool has_room(const Solid& piece, const DecomposeOptions& options) {
  const Obstacles table({}, options.table_radius_mm, piece.base.normal, piece.base.height);
  return table.empty() ||
         std::all_of(piece.mesh.points.begin(), piece.mesh.points.end(), [&](const Vector& p) {
           return table.overlap_mm(options.nozzle, p + 0.1 * piece.base.normal) <= -1;
         });
}

}  // namespace kinebus::compose
