// The assemblies of M4's table 6, side by side.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "gateway/kinematics/m4.hpp"
#include "tools/drawing/document.hpp"
#include "tools/paper_numbers/numbers.hpp"

namespace kinebus::papers {
namespace {

using drawing::Anchor;
using drawing::Point;

std::string words(const char* format, auto... values) {
  char text[128];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// One assembly about the middle `x` of its panel.
void draw_assembly(drawing::Document& document, const M4Geometry& g, const Vector3& inputs,
                   const M4Assembly& a, double x) {
  constexpr double kScale = 0.285, kBottom = 430;
  const auto at = [&](double x_mm, double y_mm) { return Point{x + kScale * x_mm, kBottom - kScale * y_mm}; };
  const char* colour = a.mirrored ? "#e07b39" : "#29788e";
  const double c = std::cos(a.pose.phi_rad), s = std::sin(a.pose.phi_rad), l = g.triangle_mm / 2;
  const double height = (a.mirrored ? -1 : 1) * std::sqrt(3.0) * l;
  const std::array<Point, 3> corners{{{a.pose.x_mm - l * c, a.pose.y_mm - l * s},
                                      {a.pose.x_mm + l * c, a.pose.y_mm + l * s},
                                      {a.pose.x_mm - height * s, a.pose.y_mm + height * c}}};
  const double rail_mm = g.rails_mm / 2;
  for (const double side : {-1.0, 1.0})
    document.line(at(side * rail_mm, 0), at(side * rail_mm, 1150),
                  {.stroke = drawing::kFaint, .width = 6, .round = true});
  document.line(at(-rail_mm, inputs[2]), at(rail_mm, inputs[2]), {.stroke = drawing::kFaint, .dash = "5 5"});
  std::array<Point, 3> drawn{};
  Point middle;
  for (std::size_t i = 0; i < 3; ++i) {
    drawn[i] = at(corners[i].x, corners[i].y);
    middle.x += corners[i].x / 3;
    middle.y += corners[i].y / 3;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const Point block = at((i == 0 ? -1 : 1) * rail_mm, inputs[i]);
    document.line(block, drawn[i], {.stroke = drawing::kMuted, .width = 3});
    document.rectangle({block.x - 9, block.y - 13, 18, 26}, {}, 3);
  }
  document.polygon(drawn,
                   {.fill = colour, .stroke = colour, .width = 3, .fill_opacity = 0.35, .round = true});
  constexpr const char* kNames[] = {"A", "B", "C"};
  for (std::size_t i = 0; i < 3; ++i) {
    const Point beside =
        at(middle.x + 1.55 * (corners[i].x - middle.x), middle.y + 1.55 * (corners[i].y - middle.y));
    document.text({beside.x, beside.y + 5}, kNames[i], {.anchor = Anchor::kMiddle});
  }
  document.text({x, 478}, a.mirrored ? "mirrored triangle" : "the real machine",
                {.size = 15, .anchor = Anchor::kMiddle, .fill = colour, .bold = true});
  document.text(
      {x, 502},
      words("phi %.2f deg, x %.2f, y %.2f mm", a.pose.phi_rad / kRadPerDeg, a.pose.x_mm, a.pose.y_mm),
      {.anchor = Anchor::kMiddle});
  document.text({x, 524}, words("residual %.0e mm", std::max(a.residual_mm, 1e-14)),
                {.size = 12, .anchor = Anchor::kMiddle, .fill = drawing::kMuted});
}

}  // namespace

std::string draw_m4_assemblies(const M4Geometry& g) {
  const Vector3 inputs{932.6, 1029.4, 283.4};
  auto found = m4_assemblies(g, inputs);
  std::erase_if(found, [](const M4Assembly& a) { return !a.block_above[0] || !a.block_above[1]; });
  if (found.size() > 4) found.resize(4);
  drawing::Document document(1300, 560);
  document.heading(40, "Assemblies of M4 for y1 = 932.6, y2 = 1029.4, y3 = 283.4 mm",
                   "Blocks above the tool. Two are the real machine's; two need the triangle mirrored (C on "
                   "the other side "
                   "of AB).");
  constexpr double kPanel = 310;
  for (std::size_t k = 0; k < found.size(); ++k)
    draw_assembly(document, g, inputs, found[k], 35 + kPanel * (static_cast<double>(k) + 0.5));
  return document.svg();
}

}  // namespace kinebus::papers
