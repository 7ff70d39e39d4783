#pragma once
// The largest value that something has in a machine's workspace, by a search.

#include <array>
#include <cmath>
#include <numbers>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus::papers {

/// A standing cylinder over the table, at all tilts.
struct Room {
  double radius_mm = 100;
  Interval z_mm{0, 200}, a_rad{};
};

struct Worst {
  double value = -HUGE_VAL;
  Pose pose{};
};

/// Largest `value` over the room: a grid of its poses, then from each of the best ones, steps along the four
/// axes that halve until they are rounding. `value` is -infinity where a pose does not count. Finds the
/// largest value of what bends slowly against the grid (radius / 8, 15 deg, z and tilt / 12).
template <typename Value>
Worst worst_over(const Room& room, const Value& value) {
  constexpr int kStarts = 24;
  constexpr std::array<int, 4> kCells{8, 24, 12, 12};
  using Place = std::array<double, 4>;  // 0 .. 1 along radius, round, z, tilt
  const auto at = [&](const Place& u) {
    const double r = room.radius_mm * u[0], f = 2 * std::numbers::pi * u[1];
    return Pose{r * std::cos(f),
                r * std::sin(f),
                room.z_mm.min + (room.z_mm.max - room.z_mm.min) * u[2],
                room.a_rad.min + (room.a_rad.max - room.a_rad.min) * u[3],
                0,
                0};
  };
  std::array<std::pair<double, Place>, kStarts> starts{};
  for (auto& start : starts) start.first = -HUGE_VAL;
  for (int i = 0; i <= kCells[0]; ++i)
    for (int k = 0; k < (i == 0 ? 1 : kCells[1]); ++k)
      for (int z = 0; z <= kCells[2]; ++z)
        for (int a = 0; a <= kCells[3]; ++a) {
          const Place u{1.0 * i / kCells[0], 1.0 * k / kCells[1], 1.0 * z / kCells[2], 1.0 * a / kCells[3]};
          const double v = value(at(u));
          for (std::size_t s = 0; s < starts.size(); ++s) {
            if (!(v > starts[s].first)) continue;
            for (std::size_t t = starts.size() - 1; t > s; --t) starts[t] = starts[t - 1];
            starts[s] = {v, u};
            break;
          }
        }
  Worst worst;
  for (auto [best, u] : starts) {
    if (!(best > -HUGE_VAL)) continue;
    for (double step = 0.5; step > 1e-9;) {
      bool better = false;
      for (std::size_t axis = 0; axis < u.size(); ++axis)
        for (const double way : {-1.0, 1.0}) {
          Place next = u;
          next[axis] += way * step / kCells[axis];
          if (axis != 1) next[axis] = std::min(1.0, std::max(0.0, next[axis]));
          const double v = value(at(next));
          if (!(v > best)) continue;
          best = v;
          u = next;
          better = true;
        }
      if (!better) step /= 2;
    }
    if (best > worst.value) worst = {best, at(u)};
  }
  return worst;
}

}  // namespace kinebus::papers
