// The equations of M4's paper: its path, and the blocks' heights for a pose.

#include <cmath>

#include "tools/paper_numbers/m4_path.hpp"

namespace kinebus::papers {

PlanarPose m4_path_at(double t_s, const M4Build& build) {
  return {200 * std::cos(t_s), 100 + 200 * std::sin(t_s), -0.3 + 0.2 * t_s + build.turned_rad};
}

std::optional<Vector3> m4_blocks(const M4Geometry& g, const PlanarPose& p, const M4Build& build) {
  const double c = std::cos(p.phi_rad), s = std::sin(p.phi_rad), l = g.triangle_mm / 2;
  const double h1 = p.x_mm - l * c + g.rails_mm / 2, h2 = p.x_mm + l * c - g.rails_mm / 2;
  if (std::abs(h1) >= g.rod_mm || std::abs(h2) >= g.rod_mm) return std::nullopt;
  return Vector3{p.y_mm - l * s + build.side1 * std::sqrt(g.rod_mm * g.rod_mm - h1 * h1),
                 p.y_mm + l * s + build.side2 * std::sqrt(g.rod_mm * g.rod_mm - h2 * h2),
                 p.y_mm + std::sqrt(3.0) * l * c};
}

}  // namespace kinebus::papers
