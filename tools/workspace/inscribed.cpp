// The largest cylinder around the table's axis: the table turns, so only what is allowed all around counts.

#include <numbers>

#include "tools/workspace/scan.hpp"

namespace kinebus::workspace {

double Cylinder::volume_mm3() const {
  return std::numbers::pi * radius_mm * radius_mm * (z_max_mm - z_min_mm);
}

Cylinder largest_cylinder(const Scan& s, int tilt) {
  const std::uint64_t all = s.tilts == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << s.tilts) - 1;
  // How many cells from the axis outwards are allowed on every ray of a plane.
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
  Cylinder best;
  for (int low = 0; low < s.planes; ++low) {
    int least = s.radii;
    for (int high = low; high < s.planes; ++high) {
      least = std::min(least, free[static_cast<std::size_t>(high)]);
      if (least == 0) break;
      const Cylinder c{least * s.options.step_mm, s.room.z_min_mm + low * s.options.step_mm,
                       s.room.z_min_mm + (high + 1) * s.options.step_mm};
      if (c.volume_mm3() > best.volume_mm3()) best = c;
    }
  }
  return best;
}

}  // namespace kinebus::workspace
