#pragma once
// What a vertex carries to the graphics card beside its place: one byte for each way of colouring.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "gui/scene/machine_model.hpp"
#include "gui/scene/tool_path.hpp"

namespace kinebus::gui {

/// kPart: as one body, in one colour.
enum class PathColouring : std::uint8_t { kFeed, kLayer, kMargin, kPart, kFeature };
inline constexpr std::size_t kPathColourings = 5;

struct PathVertex {
  std::array<float, 3> point_mm;
  std::array<std::uint8_t, 4> shade;  ///< feed, layer, margin, feature: 0 .. 255 along the ramp
};

struct PathShades {
  std::vector<PathVertex> vertices;
  std::uint16_t feed_min_mm_per_min = 0, feed_max_mm_per_min = 0;  ///< of work; ends of the feed ramp
  double least_margin = 1;                                         ///< 0 .. 1; with a model only
  std::uint32_t least_margin_line = 0;
};

PathShades shade_path(const ToolPath& path, const std::optional<MachineModel>& model,
                      const std::function<bool()>& cancelled = {});

/// Colours of a ramp, from 0 to 1, as sRGB; of kFeature: those of PathFeature, in its order.
const std::array<std::array<float, 3>, 9>& colour_ramp(PathColouring colouring);

}  // namespace kinebus::gui
