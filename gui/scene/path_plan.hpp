#pragma once
// Which lines of which level are drawn for a picture: by distance, by the layers chosen, by how far the job
// is, and by how many lines the picture may cost. Pure: tested without a graphics context.

#include <QMatrix4x4>
#include <QVector3D>
#include <vector>

#include "gui/scene/path_levels.hpp"

namespace kinebus::gui {

struct PathView {
  QMatrix4x4 clip;                                         ///< part frame to clip space
  QVector3D eye_mm;                                        ///< part frame
  float mm_per_pixel_at_1mm = 0.001F;                      ///< size of a pixel for each mm of distance
  std::uint32_t first_layer = 0, last_layer = UINT32_MAX;  ///< both shown
  std::uint32_t done_vertex = UINT32_MAX;                  ///< vertices before it are made already
  std::uint32_t end_vertex = UINT32_MAX;                   ///< from it on nothing is shown
  bool show_remaining = true;                              ///< what is not made yet, pale
  bool show_travel = false;
  std::size_t max_lines = SIZE_MAX;
};

enum class PathStyle : std::uint8_t { kWork, kTravel, kRemaining };

/// Lines first .. last - 1 of one index list.
struct DrawRange {
  PathStyle style{};
  std::uint8_t level = 0;
  std::uint16_t layers = 1;  ///< that these lines stand for: as wide as so many layers are high
  IndexRange lines;
  friend bool operator==(const DrawRange& a, const DrawRange& b) {
    return a.style == b.style && a.level == b.level && a.layers == b.layers &&
           a.lines.first == b.lines.first && a.lines.last == b.lines.last;
  }
};

struct DrawPlan {
  std::vector<DrawRange> ranges;  ///< neighbours are joined
  std::size_t lines = 0;
  bool thinned = false;  ///< chunks or detail were left out to keep within max_lines
};

/// A level leaves out at most about a pixel where it is drawn. When that is more than `max_lines`, lines
/// become coarser or one stands for several layers, whichever is seen less; the topmost chunks and the one
/// that is being made stay whole.
DrawPlan plan_drawing(const PathLevels& levels, const PathView& view);

}  // namespace kinebus::gui
