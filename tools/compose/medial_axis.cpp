#include "tools/compose/medial_axis.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

namespace kinebus::compose {
namespace {

constexpr int kSections = 25;

/// Centre of the section {q : normal . q = height}, holes taken out. nullopt: none.
std::optional<Vector> centre_of_section(const TriangleMesh& mesh, const Vector& normal, double height) {
  const Vector origin = height * normal;
  double area = 0;
  Vector moment = Vector::Zero();
  for (const auto& face : mesh.faces) {
    std::array<Vector, 2> ends;
    std::size_t found = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector &p = mesh.points[face[k]], &q = mesh.points[face[(k + 1) % 3]];
      const double dp = normal.dot(p) - height, dq = normal.dot(q) - height;
      if ((dp < 0) != (dq < 0) && found < 2) ends[found++] = p + dp / (dp - dq) * (q - p);
    }
    if (found < 2) continue;
    // The body lies to the left of the way that its outward normal gives.
    const Vector &a = mesh.points[face[0]], &b = mesh.points[face[1]], &c = mesh.points[face[2]];
    if (normal.cross((b - a).cross(c - a)).dot(ends[1] - ends[0]) < 0) std::swap(ends[0], ends[1]);
    const Vector p = ends[0] - origin, q = ends[1] - origin;
    const double part = 0.5 * normal.dot(p.cross(q));
    area += part;
    moment += part / 3 * (p + q);
  }
  constexpr double kLeast_mm2 = 1e-6;
  if (!(area > kLeast_mm2)) return {};
  return origin + moment / area;
}

}  // namespace

double angle_to_medial_axis(const TriangleMesh& mesh, const Vector& normal) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Vector& p : mesh.points) {
    low = std::min(low, normal.dot(p));
    high = std::max(high, normal.dot(p));
  }
  // Least squares of centre over height; what is left across the normal is the lean.
  double n = 0, sum_h = 0, sum_hh = 0;
  Vector sum = Vector::Zero(), sum_hc = Vector::Zero();
  for (int k = 0; k < kSections; ++k) {
    const double height = low + (high - low) * (0.25 + 0.5 * (k + 0.5) / kSections);
    const auto centre = centre_of_section(mesh, normal, height);
    if (!centre) continue;
    const double h = height - low;
    const Vector c = *centre - height * normal;
    n += 1;
    sum_h += h;
    sum_hh += h * h;
    sum += c;
    sum_hc += h * c;
  }
  const double spread = n * sum_hh - sum_h * sum_h;
  if (!(spread > 0)) return 0;
  return std::atan(((n * sum_hc - sum_h * sum) / spread).norm());
}

}  // namespace kinebus::compose
