#pragma once
// The tool path of a job as a picture needs it: vertices in part coordinates, in the order of the job, with
// what colours them. Single precision: 1,000,000 vertices are some 24 MB.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gui/scene/path_features.hpp"

namespace kinebus::gui {

struct Box {
  std::array<float, 3> low_mm{1e30F, 1e30F, 1e30F};
  std::array<float, 3> high_mm{-1e30F, -1e30F, -1e30F};
  bool empty() const { return low_mm[0] > high_mm[0]; }
  void add(const std::array<float, 3>& point_mm);
  void add(const Box& other);
  friend bool operator==(const Box&, const Box&) = default;
};

/// How the tool came to a vertex.
enum class PathKind : std::uint8_t {
  kTravel,  ///< above or beside the part: nothing is deposited or cut
  kWork,    ///< extrusion, or a cut of a job that extrudes nothing
};

/// Vertices first .. last - 1 that were deposited at about the same height.
struct PathLayer {
  std::uint32_t first = 0, last = 0;
  float z_mm = 0;
};

struct ToolPath {
  std::vector<std::array<float, 3>> points_mm;
  std::vector<std::uint32_t> lines;              ///< of the job, from 1; ascending
  std::vector<std::uint16_t> feeds_mm_per_min;   ///< programmed; traverses 0
  std::vector<PathKind> kinds;                   ///< of the move that ends at the vertex
  std::vector<std::array<float, 2>> tilts_rad;   ///< A and C; empty: the job never turns anything
  std::vector<FeatureScanner::Change> features;  ///< by line; none: the slicer does not say
  std::vector<PathLayer> layers;                 ///< ascending, together all vertices
  Box bounds_mm;                                 ///< of what is worked
  std::uint32_t line_count = 0;
  std::uint32_t refused_lines =
      0;  ///< lines that are no G-code for this machine; the path goes on behind them
  double work_length_mm = 0;
  bool extrudes = false;  ///< what is worked is deposited, not cut

  std::size_t size() const { return points_mm.size(); }
  /// First vertex of `line` or of a later line; size() when none is.
  std::size_t vertex_at_line(std::uint32_t line) const;
  /// Layer of a vertex; 0 when there are no layers.
  std::size_t layer_at_vertex(std::size_t vertex) const;
};

}  // namespace kinebus::gui
