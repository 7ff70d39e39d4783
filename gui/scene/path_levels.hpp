#pragma once
// Level of detail: the same path with fewer and fewer vertices, as index lists into it, in chunks that can be
// skipped when they are out of sight. Indices keep the path's order, so that "up to here" cuts every level
// alike.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "gui/scene/tool_path.hpp"

namespace kinebus::gui {

inline constexpr std::size_t kPathLevels = 5;
/// What a level may leave out, mm: level 0 is the path itself.
inline constexpr std::array<float, kPathLevels> kLevelTolerance_mm{0, 0.15F, 0.5F, 1.5F, 5};

/// Line pairs first .. last - 1 of a level's index list.
struct IndexRange {
  std::uint32_t first = 0, last = 0;
  std::uint32_t count() const { return last - first; }
};

struct PathChunk {
  std::uint32_t layer = 0;
  std::uint32_t first_vertex = 0, last_vertex = 0;  ///< [first, last)
  Box bounds_mm;
  std::array<IndexRange, kPathLevels> work;
  std::array<IndexRange, 2> travel;  ///< level 0 and one coarse level
};

struct PathLevels {
  std::vector<PathChunk> chunks;                             ///< in the path's order
  std::array<std::vector<std::uint32_t>, kPathLevels> work;  ///< two indices a line
  std::array<std::vector<std::uint32_t>, 2> travel;
  float layer_mm = 0;  ///< mean rise from layer to layer; 0: one layer
};

/// Every vertex of level k is nearer than kLevelTolerance_mm[k] to the polyline that the level draws.
/// `cancelled` is asked now and then; an empty result then.
PathLevels make_path_levels(const ToolPath& path, const std::function<bool()>& cancelled = {});

}  // namespace kinebus::gui
