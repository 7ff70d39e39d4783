// The largest cylinder around the table's axis: the table turns, so only what is allowed all around counts.

#include <algorithm>
#include <numbers>
#include <vector>

#include "tools/workspace/scan.hpp"

namespace kinebus::workspace {

double Cylinder::volume_mm3() const {
  return std::numbers::pi * radius_mm * radius_mm * (z_max_mm - z_min_mm);
}

namespace {

/// How many cells from the axis outwards are allowed on every ray of each plane.
std::vector<int> free_cells(const Scan& s, int tilt) {
  const std::uint64_t all = s.tilts == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << s.tilts) - 1;
  std::vector<int> free(static_cast<std::size_t>(s.planes), 0);
  for (int plane = 0; plane < s.planes; ++plane)
    for (int radius = 0; radius < s.radii; ++radius) {
      bool around = true;
      for (int ray = 0; ray < s.rays && around; ++ray) {
        const std::uint64_t allowed = s.allowed[s.cell(plane, ray, radius)];
        around = tilt < 0 ? allowed == all : (allowed >> tilt & 1) != 0;
      }
      if (!around) break;
      free[static_cast<std::size_t>(plane)] = radius + 1;
    }
  return free;
}

/// The largest whose lowest plane is `low`.
Cylinder largest_from(const Scan& s, const std::vector<int>& free, int low, double most_radius_mm) {
  Cylinder best;
  int least = s.radii;
  for (int high = low; high < s.planes; ++high) {
    least = std::min(least, free[static_cast<std::size_t>(high)]);
    if (least == 0) break;
    const double top_mm = s.room.z_min_mm + (high + 1) * s.options.step_mm;
    const Cylinder c{std::min(least * s.options.step_mm, most_radius_mm),
                     s.room.z_min_mm + low * s.options.step_mm, std::min(top_mm, s.room.z_max_mm)};
    if (c.volume_mm3() > best.volume_mm3()) best = c;
  }
  return best;
}

}  // namespace

Cylinder largest_cylinder(const Scan& s, int tilt) {
  const std::vector<int> free = free_cells(s, tilt);
  Cylinder best;
  for (int low = 0; low < s.planes; ++low)
    if (const Cylinder c = largest_from(s, free, low, s.radii * s.options.step_mm);
        c.volume_mm3() > best.volume_mm3())
      best = c;
  return best;
}

Cylinder standing_cylinder(const Scan& s, double table_radius_mm) {
  int low = 0;
  while (low + 1 < s.planes && s.z_mm(low) < 0) ++low;
  Cylinder standing = largest_from(s, free_cells(s, -1), low, table_radius_mm);
  // The plane nearest to the table reaches a little below or begins a little above it.
  if (standing.z_max_mm > 0) standing.z_min_mm = std::max(0.0, s.room.z_min_mm);
  return standing;
}

}  // namespace kinebus::workspace
