#include "gui/scene/path_levels.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus::gui {
namespace {

using Point = std::array<float, 3>;
constexpr std::uint32_t kChunkVertices = 4096;
// A line that is simplified is looked back over at most so many vertices: the cost stays linear.
constexpr std::uint32_t kLookBack = 24;

float distance_squared_to_line(const Point& p, const Point& a, const Point& b) {
  float ab = 0, ap_ab = 0, ap = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const float along = b[i] - a[i], to = p[i] - a[i];
    ab += along * along;
    ap_ab += along * to;
    ap += to * to;
  }
  if (!(ab > 0)) return ap;
  const float share = std::clamp(ap_ab / ab, 0.0F, 1.0F);
  return std::max(0.0F, ap - 2 * share * ap_ab + share * share * ab);
}

/// Adds the run from .. to (vertices joined by moves of one kind) with what the tolerance allows left out.
void simplify(const ToolPath& path, std::uint32_t from, std::uint32_t to, float tolerance_mm,
              std::vector<std::uint32_t>& indices) {
  const auto& points = path.points_mm;
  if (tolerance_mm <= 0) {
    for (std::uint32_t i = from + 1; i <= to; ++i) indices.insert(indices.end(), {i - 1, i});
    return;
  }
  const float limit = tolerance_mm * tolerance_mm;
  std::uint32_t kept = from;
  while (kept < to) {
    std::uint32_t reach = kept + 1;
    while (reach < to && reach - kept < kLookBack) {
      const std::uint32_t next = reach + 1;
      bool fits = true;
      for (std::uint32_t k = kept + 1; k < next && fits; ++k)
        fits = distance_squared_to_line(points[k], points[kept], points[next]) <= limit;
      if (!fits) break;
      reach = next;
    }
    indices.insert(indices.end(), {kept, reach});
    kept = reach;
  }
}

class Maker {
 public:
  explicit Maker(const ToolPath& path) : path_(path) {
    // Known sizes: growing by doubling would cost half again the memory.
    levels_.work[0].reserve(path.size() * 2);
    levels_.work[1].reserve(path.size() / 2);
  }

  void chunk(std::uint32_t layer, std::uint32_t first, std::uint32_t last) {
    PathChunk chunk{.layer = layer,
                    .first_vertex = first,
                    .last_vertex = last,
                    .bounds_mm = {},
                    .work = {},
                    .travel = {}};
    begin(chunk);
    // Runs of one kind; vertex i stands for the move from i - 1.
    for (std::uint32_t i = std::max(first, 1u); i < last;) {
      std::uint32_t end = i + 1;
      while (end < last && path_.kinds[end] == path_.kinds[i]) ++end;
      run(path_.kinds[i], i - 1, end - 1);
      for (std::uint32_t k = i - 1; k < end; ++k) chunk.bounds_mm.add(path_.points_mm[k]);
      i = end;
    }
    finish(chunk);
    levels_.chunks.push_back(chunk);
  }

  PathLevels take() { return std::move(levels_); }

 private:
  void begin(PathChunk& chunk) {
    for (std::size_t k = 0; k < kPathLevels; ++k) chunk.work[k].first = lines(levels_.work[k]);
    for (std::size_t k = 0; k < 2; ++k) chunk.travel[k].first = lines(levels_.travel[k]);
  }
  void finish(PathChunk& chunk) {
    for (std::size_t k = 0; k < kPathLevels; ++k) chunk.work[k].last = lines(levels_.work[k]);
    for (std::size_t k = 0; k < 2; ++k) chunk.travel[k].last = lines(levels_.travel[k]);
  }
  static std::uint32_t lines(const std::vector<std::uint32_t>& indices) {
    return static_cast<std::uint32_t>(indices.size() / 2);
  }
  void run(PathKind kind, std::uint32_t from, std::uint32_t to) {
    if (kind == PathKind::kTravel) {
      simplify(path_, from, to, 0, levels_.travel[0]);
      simplify(path_, from, to, kLevelTolerance_mm[2], levels_.travel[1]);
      return;
    }
    for (std::size_t k = 0; k < kPathLevels; ++k)
      simplify(path_, from, to, kLevelTolerance_mm[k], levels_.work[k]);
  }

  const ToolPath& path_;
  PathLevels levels_;
};

}  // namespace

PathLevels make_path_levels(const ToolPath& path, const std::function<bool()>& cancelled) {
  Maker maker(path);
  for (std::size_t layer = 0; layer < path.layers.size(); ++layer) {
    if (cancelled && cancelled()) return {};
    const PathLayer& l = path.layers[layer];
    for (std::uint32_t first = l.first; first < l.last; first += kChunkVertices)
      maker.chunk(static_cast<std::uint32_t>(layer), first, std::min(l.last, first + kChunkVertices));
  }
  PathLevels levels = maker.take();
  if (path.layers.size() > 1)
    levels.layer_mm = std::abs(path.layers.back().z_mm - path.layers.front().z_mm) /
                      static_cast<float>(path.layers.size() - 1);
  return levels;
}

}  // namespace kinebus::gui
