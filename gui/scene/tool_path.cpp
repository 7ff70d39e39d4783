#include "gui/scene/tool_path.hpp"

#include <algorithm>

namespace kinebus::gui {

void Box::add(const std::array<float, 3>& point_mm) {
  for (std::size_t i = 0; i < 3; ++i) {
    low_mm[i] = std::min(low_mm[i], point_mm[i]);
    high_mm[i] = std::max(high_mm[i], point_mm[i]);
  }
}

void Box::add(const Box& other) {
  if (other.empty()) return;
  add(other.low_mm);
  add(other.high_mm);
}

std::size_t ToolPath::vertex_at_line(std::uint32_t line) const {
  return static_cast<std::size_t>(std::lower_bound(lines.begin(), lines.end(), line) - lines.begin());
}

std::size_t ToolPath::layer_at_vertex(std::size_t vertex) const {
  const auto after = std::upper_bound(layers.begin(), layers.end(), vertex,
                                      [](std::size_t v, const PathLayer& layer) { return v < layer.first; });
  return after == layers.begin() ? 0 : static_cast<std::size_t>(after - layers.begin()) - 1;
}

}  // namespace kinebus::gui
