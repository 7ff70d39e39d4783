#include "tools/drawing/colour.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus::drawing {

std::array<int, 3> scale_colour(double fraction) {
  // The colour map "viridis" at six places.
  constexpr int kKnots = 6;
  constexpr std::array<std::array<double, 3>, kKnots> kMap{
      {{68, 1, 84}, {64, 67, 135}, {41, 120, 142}, {34, 167, 132}, {121, 209, 81}, {253, 231, 37}}};
  const double x = std::clamp(fraction, 0.0, 1.0) * (kKnots - 1);
  const auto i = static_cast<std::size_t>(std::min<double>(kKnots - 2, x));
  std::array<int, 3> c{};
  for (std::size_t k = 0; k < 3; ++k)
    c[k] = static_cast<int>(
        std::lround(kMap[i][k] + (x - static_cast<double>(i)) * (kMap[i + 1][k] - kMap[i][k])));
  return c;
}

std::string scale_rgb(double fraction) {
  const auto c = scale_colour(fraction);
  return rgb(c[0], c[1], c[2]);
}

void colour_bar(Document& document, const Box& box) {
  constexpr int kSteps = 64;
  const bool standing = box.height > box.width;
  const auto group = document.group({.crisp = true});
  for (int i = 0; i < kSteps; ++i) {
    const std::string fill = scale_rgb((i + 0.5) / kSteps);
    const double from = static_cast<double>(i) / kSteps, step = 1.0 / kSteps;
    if (standing)
      document.rectangle(
          {box.x, box.bottom() - box.height * (from + step), box.width, box.height * step + 0.5},
          {.fill = fill});
    else
      document.rectangle({box.x + box.width * from, box.y, box.width * step + 0.5, box.height},
                         {.fill = fill});
  }
}

}  // namespace kinebus::drawing
