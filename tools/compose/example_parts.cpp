#include "tools/compose/example_parts.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tools/compose/mesh_kernel.hpp"

namespace kinebus::compose {
namespace {

using Profile = std::vector<std::array<double, 2>>;  // x, z in mm, counter-clockwise seen against y

/// The profile in the xz plane, `depth` thick along y about y = 0.
TriangleMesh extrude(const Profile& profile, double depth_mm) {
  std::vector<Vector> points;
  for (const double y : {-depth_mm / 2, depth_mm / 2})
    for (const auto& p : profile) points.emplace_back(p[0], y, p[1]);
  const std::size_t n = profile.size();
  std::vector<std::vector<std::size_t>> polygons(2);
  for (std::size_t i = 0; i < n; ++i) {
    polygons[0].push_back(i);
    polygons[1].push_back(n + (n - 1 - i));
    const std::size_t next = (i + 1) % n;
    polygons.push_back({i, i + n, next + n, next});
  }
  return close_mesh(points, std::move(polygons), "extruded profile").first;
}

TriangleMesh box(const Vector& low, const Vector& high) {
  TriangleMesh out =
      extrude({{low[0], low[2]}, {high[0], low[2]}, {high[0], high[2]}, {low[0], high[2]}}, high[1] - low[1]);
  for (Vector& p : out.points) p[1] += (low[1] + high[1]) / 2;
  return out;
}

/// A round column along a bent line in the xz plane: rings square to the bisector at each bend.
TriangleMesh column(const std::vector<Vector>& line, double radius_mm) {
  constexpr std::size_t kSides = 24;
  std::vector<Vector> points;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Vector in = k > 0 ? Vector((line[k] - line[k - 1]).normalized()) : Vector(0, 0, 1);
    const Vector out = k + 1 < line.size() ? Vector((line[k + 1] - line[k]).normalized()) : in;
    const Vector middle = (in + out).normalized();
    const Vector y(0, 1, 0), across = y.cross(middle);
    const double stretch = 1 / middle.dot(in);
    for (std::size_t i = 0; i < kSides; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kSides;
      points.push_back(line[k] + radius_mm * (std::cos(angle) * stretch * across + std::sin(angle) * y));
    }
  }
  std::vector<std::vector<std::size_t>> polygons(2);
  for (std::size_t i = 0; i < kSides; ++i) {
    polygons[0].push_back(kSides - 1 - i);
    polygons[1].push_back((line.size() - 1) * kSides + i);
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const std::size_t a = k * kSides + i, b = k * kSides + (i + 1) % kSides;
      polygons.push_back({a, b, b + kSides, a + kSides});
    }
  }
  return close_mesh(points, std::move(polygons), "column").first;
}

TriangleMesh t_part() {
  return extrude({{-8, 0}, {8, 0}, {8, 30}, {26, 30}, {26, 38}, {-26, 38}, {-26, 30}, {-8, 30}}, 14);
}

/// Two branches that lean 60 degrees.
TriangleMesh y_part() {
  const double s = std::sin(std::numbers::pi / 3), c = 0.5, length = 32, width = 12;
  const auto branch = [&](double side, double along, double across) {
    return std::array<double, 2>{side * (6 + along * s - across * c), 22 + along * c + across * s};
  };
  Profile profile{{-6, 0}, {6, 0}, {6, 22}, branch(1, length, 0), branch(1, length, width)};
  profile.push_back({0, 22 + width / s + 6 * c / s});  // where the branches' upper sides meet
  profile.push_back(branch(-1, length, width));
  profile.push_back(branch(-1, length, 0));
  profile.push_back({-6, 22});
  return extrude(profile, 14);
}

/// A stem that bends over in a quarter circle, level at its end, with a lip that rises.
TriangleMesh hook_part() {
  Profile inner, outer;
  constexpr double kRadius = 14, kWidth = 10, kStem = 24;
  for (int i = 0; i <= 9; ++i) {
    const double angle = std::numbers::pi / 2 * i / 9;
    const auto at = [&](double r) {
      return std::array<double, 2>{kRadius + kWidth - r * std::cos(angle), kStem + r * std::sin(angle)};
    };
    inner.push_back(at(kRadius)), outer.push_back(at(kRadius + kWidth));
  }
  Profile profile{{0, 0}, {kWidth, 0}};
  profile.insert(profile.end(), inner.begin(), inner.end());
  const double x = inner.back()[0] + 14, z = inner.back()[1];
  profile.push_back({x, z});
  profile.push_back({x + 10, z + 10});
  profile.push_back({x + 10, z + 22});
  profile.push_back({x, z + 22});
  profile.push_back({x, z + kWidth});
  profile.insert(profile.end(), outer.rbegin(), outer.rend());
  for (auto& p : profile) p[0] -= 22;
  return extrude(profile, 12);
}

TriangleMesh table_part() {
  TriangleMesh out = unite(box({-9, -9, 0}, {9, 9, 26}), box({-24, -20, 25}, {24, 20, 32}));
  // The angled leg rests on the pedestal's side and rises outward past the top.
  const double lean = 50 * std::numbers::pi / 180;
  const Vector along(std::sin(lean), 0, std::cos(lean)), across(std::cos(lean), 0, -std::sin(lean));
  const Vector foot(14, 0, 27);
  std::vector<Vector> points;
  for (const double y : {-5.0, 5.0})
    for (const auto& [u, v] : std::vector<std::array<double, 2>>{{0, 4}, {0, -4}, {40, -4}, {40, 4}})
      points.push_back(foot + u * along + v * across + Vector(0, y, 0));
  TriangleMesh leg =
      close_mesh(points, {{0, 1, 2, 3}, {7, 6, 5, 4}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}},
                 "leg")
          .first;
  return unite(out, leg);
}

TriangleMesh two_piece_part() {
  const double lean = 50 * std::numbers::pi / 180;
  const Vector knee(0, 0, 28);
  TriangleMesh out = column({{0, 0, 0}, knee, knee + 36 * Vector(std::sin(lean), 0, std::cos(lean))}, 11);
  return out;
}

}  // namespace

std::vector<std::string> example_names() {
  return {"t", "y", "hook", "table", "two-piece"};
}

TriangleMesh example_part(const std::string& name) {
  if (name == "t") return t_part();
  if (name == "y") return y_part();
  if (name == "hook") return hook_part();
  if (name == "table") return table_part();
  if (name == "two-piece") return two_piece_part();
  throw std::runtime_error("no example part '" + name + "': there are t, y, hook, table and two-piece");
}

}  // namespace kinebus::compose
