#include "tools/compose/overhang.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace kinebus::compose {
namespace {

constexpr double kSlackRad = 0.5 * std::numbers::pi / 180;
constexpr double kOnBaseMm = 0.05;

/// Share of a triangle's area over the plane; d: the corners' heights over it.
double share_over(double d0, double d1, double d2) {
  if (d0 > d1) std::swap(d0, d1);
  if (d1 > d2) std::swap(d1, d2);
  if (d0 > d1) std::swap(d0, d1);
  if (d0 >= 0) return 1;
  if (d2 <= 0) return 0;
  if (d1 <= 0) return d2 / (d2 - d0) * d2 / (d2 - d1);
  return 1 - d0 / (d0 - d1) * d0 / (d0 - d2);
}

}  // namespace

Overhang::Overhang(const TriangleMesh& mesh, double limit_rad)
    : mesh_(mesh), limit_sin_(std::sin(limit_rad + kSlackRad)) {
  for (const auto& face : mesh.faces) {
    const Vector& a = mesh.points[face[0]];
    const Vector cross = (mesh.points[face[1]] - a).cross(mesh.points[face[2]] - a);
    const double twice = cross.norm();
    normals_.push_back(twice > 0 ? Vector(cross / twice) : Vector(0, 0, 0));
    areas_.push_back(twice / 2);
  }
}

std::vector<bool> Overhang::hanging(const Vector& up, const Plane* base) const {
  std::vector<bool> out(mesh_.faces.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (-normals_[i].dot(up) <= limit_sin_) continue;
    bool on_base = base != nullptr;
    if (on_base)
      for (const std::uint32_t corner : mesh_.faces[i])
        on_base = on_base && std::abs(base->over(mesh_.points[corner])) < kOnBaseMm;
    out[i] = !on_base;
  }
  return out;
}

double Overhang::area_mm2(const std::vector<bool>& faces) const {
  double sum = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (faces[i]) sum += areas_[i];
  return sum;
}

double Overhang::area_over(const std::vector<bool>& faces, const Plane& plane) const {
  double sum = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!faces[i]) continue;
    const auto& face = mesh_.faces[i];
    sum += areas_[i] * share_over(plane.over(mesh_.points[face[0]]), plane.over(mesh_.points[face[1]]),
                                  plane.over(mesh_.points[face[2]]));
  }
  return sum;
}

double overhang_mm2(const Solid& solid, double limit_rad) {
  const Overhang overhang(solid.mesh, limit_rad);
  return overhang.area_mm2(overhang.hanging(solid.base.normal, &solid.base));
}

}  // namespace kinebus::compose
