#include "tools/compose/nozzle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace kinebus::compose {

double Nozzle::radius_at(double height_mm) const {
  if (height_mm < profile.front().height_mm) return 0;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const Corner &low = profile[i - 1], &high = profile[i];
    if (height_mm < high.height_mm)
      return low.radius_mm + (high.radius_mm - low.radius_mm) * (height_mm - low.height_mm) /
                                 (high.height_mm - low.height_mm);
  }
  return profile.back().radius_mm;
}

double Nozzle::widest() const {
  double out = 0;
  for (const Corner& corner : profile) out = std::max(out, corner.radius_mm);
  return out;
}

Obstacles::Obstacles(const std::vector<const TriangleMesh*>& meshes, double table_radius_mm,
                     const Vector& tool_up, double lowest_tip_mm, double grid_mm)
    : up_(tool_up) {
  across_ = (std::abs(up_[0]) < 0.9 ? Vector::UnitX() : Vector::UnitY()).cross(up_).normalized();
  along_ = up_.cross(across_);
  const auto seen = [&](const Vector& q) { return Vector(across_.dot(q), along_.dot(q), up_.dot(q)); };
  for (const TriangleMesh* mesh : meshes)
    for (const auto& face : mesh->faces)
      sample(seen(mesh->points[face[0]]), seen(mesh->points[face[1]]), seen(mesh->points[face[2]]),
             lowest_tip_mm, grid_mm);
  constexpr int kSides = 48;
  for (int i = 0; i < kSides; ++i) {
    const auto rim = [&](int k) {
      const double angle = 2 * std::numbers::pi * k / kSides;
      return seen(Vector(table_radius_mm * std::cos(angle), table_radius_mm * std::sin(angle), 0));
    };
    sample(Vector(0, 0, 0), rim(i), rim(i + 1), lowest_tip_mm, grid_mm);
  }
  // Of samples in the same cell only the highest can be met first: the nozzle widens upward.
  std::unordered_map<std::int64_t, std::size_t> cells;
  std::vector<Sample> kept;
  for (const Sample& s : high_) {
    const std::int64_t key = static_cast<std::int64_t>(std::floor(s.x / grid_mm)) * 1'000'003 +
                             static_cast<std::int64_t>(std::floor(s.y / grid_mm));
    const auto [it, fresh] = cells.try_emplace(key, kept.size());
    if (fresh)
      kept.push_back(s);
    else if (kept[it->second].z < s.z)
      kept[it->second] = s;
  }
  high_ = std::move(kept);
}

void Obstacles::sample(const Vector& a, const Vector& b, const Vector& c, double lowest, double grid_mm) {
  if (std::max({a[2], b[2], c[2]}) <= lowest) return;
  const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
  const int steps = std::max(1, static_cast<int>(std::ceil(longest / (0.7 * grid_mm))));
  for (int i = 0; i <= steps; ++i)
    for (int k = 0; k + i <= steps; ++k) {
      const Vector p = a + (b - a) * i / steps + (c - a) * k / steps;
      if (p[2] > lowest) high_.push_back({p[0], p[1], p[2]});
    }
}

double Obstacles::overlap_mm(const Nozzle& nozzle, const Vector& tip) const {
  const double x = across_.dot(tip), y = along_.dot(tip), z = up_.dot(tip);
  const double widest = nozzle.widest();
  double worst = -widest;
  for (const Sample& s : high_) {
    const double height = s.z - z;
    if (height <= 0) continue;
    const double dx = s.x - x, dy = s.y - y;
    if (std::abs(dx) > widest || std::abs(dy) > widest) continue;
    worst = std::max(worst, nozzle.radius_at(height) - std::hypot(dx, dy));
  }
  return worst;
}

}  // namespace kinebus::compose
