#include "tools/workspace/boundary.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <ostream>

#include "tools/drawing/colour.hpp"

namespace kinebus::workspace {
namespace {

using Point = std::array<float, 3>;

Point at(double r, double angle, double z) {
  return {static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)),
          static_cast<float>(z)};
}

void quad(std::vector<Triangle>& out, const Point& a, const Point& b, const Point& c, const Point& d,
          float shade) {
  if (a != b) out.push_back({{a, b, c}, shade});
  if (c != d) out.push_back({{a, c, d}, shade});
}

void put_u32(std::ostream& out, std::uint32_t v) {
  for (int k = 0; k < 4; ++k) out.put(static_cast<char>(v >> (8 * k) & 0xFF));
}
void put_float(std::ostream& out, float v) {
  put_u32(out, std::bit_cast<std::uint32_t>(v));
}

}  // namespace

std::vector<Triangle> boundary(const Scan& s, int tilt, Sector cut) {
  std::vector<Triangle> out;
  const auto in = [&](int plane, int ray, int radius) {
    if (plane < 0 || plane >= s.planes || radius >= s.radii) return false;
    if (radius < 0) return true;  // the axis has no face
    ray = (ray + s.rays) % s.rays;
    const double off = s.angle_rad(ray) - (cut.from_rad + cut.to_rad) / 2;
    if (std::abs(std::remainder(off, 2 * std::numbers::pi)) < (cut.to_rad - cut.from_rad) / 2) return false;
    const std::uint64_t allowed = s.allowed[s.cell(plane, ray, radius)];
    return tilt < 0 ? allowed != 0 : (allowed >> tilt & 1) != 0;
  };
  const double step = s.options.step_mm;
  for (int plane = 0; plane < s.planes; ++plane)
    for (int ray = 0; ray < s.rays; ++ray)
      for (int radius = 0; radius < s.radii; ++radius) {
        if (!in(plane, ray, radius)) continue;
        const double a0 = s.angle_rad(ray) - s.angle_rad(1) / 2, a1 = a0 + s.angle_rad(1);
        const double r0 = radius * step, r1 = r0 + step, z0 = s.room.z_min_mm + plane * step, z1 = z0 + step;
        const float shade = static_cast<float>(std::popcount(s.allowed[s.cell(plane, ray, radius)])) /
                            static_cast<float>(s.tilts);
        if (!in(plane, ray, radius + 1))
          quad(out, at(r1, a0, z0), at(r1, a1, z0), at(r1, a1, z1), at(r1, a0, z1), shade);
        if (radius > 0 && !in(plane, ray, radius - 1))
          quad(out, at(r0, a0, z0), at(r0, a0, z1), at(r0, a1, z1), at(r0, a1, z0), shade);
        if (!in(plane + 1, ray, radius))
          quad(out, at(r0, a0, z1), at(r1, a0, z1), at(r1, a1, z1), at(r0, a1, z1), shade);
        if (!in(plane - 1, ray, radius))
          quad(out, at(r0, a0, z0), at(r0, a1, z0), at(r1, a1, z0), at(r1, a0, z0), shade);
        if (!in(plane, ray + 1, radius))
          quad(out, at(r0, a1, z0), at(r0, a1, z1), at(r1, a1, z1), at(r1, a1, z0), shade);
        if (!in(plane, ray - 1, radius))
          quad(out, at(r0, a0, z0), at(r1, a0, z0), at(r1, a0, z1), at(r0, a0, z1), shade);
      }
  return out;
}

void write_stl(std::ostream& out, const std::vector<Triangle>& triangles) {
  const char header[80] = "Kinebus workspace, mm";
  out.write(header, sizeof header);
  put_u32(out, static_cast<std::uint32_t>(triangles.size()));
  for (const Triangle& t : triangles) {
    float u[3], v[3];
    for (std::size_t k = 0; k < 3; ++k) {
      u[k] = t.corner[1][k] - t.corner[0][k];
      v[k] = t.corner[2][k] - t.corner[0][k];
    }
    float n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const float length = std::hypot(n[0], n[1], n[2]);
    for (const float c : n) put_float(out, length > 0 ? c / length : 0);
    for (const Point& p : t.corner)
      for (const float c : p) put_float(out, c);
    out.put(0);
    out.put(0);
  }
}

void write_ply(std::ostream& out, const std::vector<Triangle>& triangles) {
  out << "ply\nformat ascii 1.0\ncomment Kinebus workspace, mm; colour: share of the tilts allowed\nelement "
         "vertex "
      << 3 * triangles.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
         "property uchar blue\nelement face "
      << triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Triangle& t : triangles) {
    const auto c = drawing::scale_colour(t.shade);
    for (const Point& p : t.corner)
      out << p[0] << ' ' << p[1] << ' ' << p[2] << ' ' << c[0] << ' ' << c[1] << ' ' << c[2] << '\n';
  }
  for (std::size_t k = 0; k < triangles.size(); ++k)
    out << "3 " << 3 * k << ' ' << 3 * k + 1 << ' ' << 3 * k + 2 << '\n';
}

}  // namespace kinebus::workspace
