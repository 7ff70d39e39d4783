#include "tools/compose/section.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace kinebus::compose {
namespace {

constexpr double kLeastArea_mm2 = 1e-6;
constexpr int kDirections = 300;  // over the half sphere: 8 deg apart
constexpr double kFirstRing_rad = 0.1, kLastRing_rad = 0.0015;

}  // namespace

Sections::Sections(const TriangleMesh& mesh) : mesh_(mesh) {
  std::unordered_map<std::uint64_t, std::uint32_t> known;
  face_edges_.reserve(mesh.faces.size());
  for (const auto& face : mesh.faces) {
    std::array<std::uint32_t, 3> of_face{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = std::min(face[k], face[(k + 1) % 3]), b = std::max(face[k], face[(k + 1) % 3]);
      const auto [it, fresh] =
          known.try_emplace(std::uint64_t{a} << 32 | b, static_cast<std::uint32_t>(edges_.size()));
      if (fresh) edges_.push_back({a, b});
      of_face[k] = it->second;
    }
    face_edges_.push_back(of_face);
  }
  over_.resize(mesh.points.size());
  next_.assign(edges_.size(), -1);
}

void Sections::collect(const Plane& plane, const Vector& across, const Vector& along,
                       const Vector& middle) const {
  for (const std::uint32_t edge : crossed_) next_[edge] = -1;
  crossed_.clear();
  loop_points_.clear();
  loops_.clear();
  for (std::size_t i = 0; i < over_.size(); ++i) over_[i] = plane.over(mesh_.points[i]);
  for (std::size_t f = 0; f < face_edges_.size(); ++f) {
    const auto& face = mesh_.faces[f];
    const std::array<bool, 3> above{over_[face[0]] >= 0, over_[face[1]] >= 0, over_[face[2]] >= 0};
    if (above[0] == above[1] && above[1] == above[2]) continue;
    std::uint32_t down = 0, up = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (above[k] && !above[(k + 1) % 3]) down = face_edges_[f][k];
      if (!above[k] && above[(k + 1) % 3]) up = face_edges_[f][k];
    }
    // With the normal outward, the body lies to the left of the way from the one to the other.
    next_[down] = up;
    crossed_.push_back(down);
  }
  const auto place = [&](std::uint32_t edge) {
    const auto [a, b] = edges_[edge];
    const Vector p =
        mesh_.points[a] + over_[a] / (over_[a] - over_[b]) * (mesh_.points[b] - mesh_.points[a]) - middle;
    return Corner{across.dot(p), along.dot(p)};
  };
  for (const std::uint32_t first : crossed_) {
    if (next_[first] < 0) continue;
    Loop loop{loop_points_.size(), 0, 0, 0, 0};
    for (auto edge = static_cast<std::int64_t>(first); edge >= 0;) {
      loop_points_.push_back(place(static_cast<std::uint32_t>(edge)));
      edge = std::exchange(next_[static_cast<std::size_t>(edge)], -1);
    }
    loop_points_.pop_back();  // the first again
    loop.count = loop_points_.size() - loop.first;
    for (std::size_t i = 0; i < loop.count; ++i) {
      const Corner &p = loop_points_[loop.first + i], &q = loop_points_[loop.first + (i + 1) % loop.count];
      const double part = (p.x * q.y - q.x * p.y) / 2;
      loop.area += part;
      loop.moment_x += part / 3 * (p.x + q.x);
      loop.moment_y += part / 3 * (p.y + q.y);
    }
    loops_.push_back(loop);
  }
}

bool Sections::holds(const Loop& loop, const Corner& p) const {
  bool inside = false;
  for (std::size_t i = 0; i < loop.count; ++i) {
    const Corner &a = loop_points_[loop.first + i], &b = loop_points_[loop.first + (i + 1) % loop.count];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

std::optional<Section> Sections::at(const Plane& plane, const Vector& inside) const {
  const Vector n = plane.normal;
  const Vector across = (std::abs(n[0]) < 0.9 ? Vector::UnitX() : Vector::UnitY()).cross(n).normalized();
  const Vector along = n.cross(across), middle = inside - plane.over(inside) * n;
  collect(plane, across, along, middle);
  Section out;
  const Loop* around = nullptr;
  for (const Loop& loop : loops_) {
    if (loop.area <= kLeastArea_mm2) continue;
    ++out.parts;
    if (holds(loop, {}) && (around == nullptr || loop.area < around->area)) around = &loop;
  }
  if (around == nullptr) return {};
  double x = around->moment_x, y = around->moment_y;
  out.area_mm2 = around->area;
  for (const Loop& hole : loops_) {
    if (hole.area >= -kLeastArea_mm2 || !holds(*around, loop_points_[hole.first])) continue;
    if (holds(hole, {})) return {};
    out.area_mm2 += hole.area;
    x += hole.moment_x, y += hole.moment_y;
  }
  if (out.area_mm2 <= kLeastArea_mm2) return {};
  x /= out.area_mm2, y /= out.area_mm2;
  out.centre = middle + x * across + y * along;
  for (std::size_t i = 0; i < around->count; ++i) {
    const Corner& p = loop_points_[around->first + i];
    out.extent_mm = std::max(out.extent_mm, 2 * std::hypot(p.x - x, p.y - y));
  }
  return out;
}

std::optional<Sections::Smallest> Sections::smallest(const Vector& inside) const {
  std::optional<Smallest> best;
  // Points that lie evenly on the half sphere, on a spiral.
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = (i + 0.5) / kDirections, r = std::sqrt(1 - z * z);
    const Vector n(r * std::cos(i * turn), r * std::sin(i * turn), z);
    const auto section = at({n, n.dot(inside)}, inside);
    if (section && (!best || section->area_mm2 < best->section.area_mm2)) best = Smallest{n, *section};
  }
  return best ? smallest_near(inside, best->normal, std::numbers::pi) : best;
}

std::optional<Sections::Smallest> Sections::smallest_near(const Vector& inside, const Vector& normal,
                                                          double within_rad) const {
  const double least_cosine = std::cos(std::min(within_rad, std::numbers::pi));
  std::optional<Smallest> best;
  if (const auto section = at({normal, normal.dot(inside)}, inside)) best = Smallest{normal, *section};
  for (double ring = kFirstRing_rad; ring > kLastRing_rad;) {
    const Vector n = best ? best->normal : normal;
    const Vector across = (std::abs(n[0]) < 0.9 ? Vector::UnitX() : Vector::UnitY()).cross(n).normalized();
    const Vector along = n.cross(across);
    bool better = false;
    for (int i = 0; i < 8; ++i) {
      const double f = i * std::numbers::pi / 4;
      const Vector tried = (n + std::tan(ring) * (std::cos(f) * across + std::sin(f) * along)).normalized();
      if (tried.dot(normal) < least_cosine) continue;
      const auto section = at({tried, tried.dot(inside)}, inside);
      if (!section || (best && section->area_mm2 >= best->section.area_mm2 * (1 - 1e-9))) continue;
      best = Smallest{tried, *section};
      better = true;
    }
    if (!better) ring /= 2;
  }
  return best;
}

}  // namespace kinebus::compose
