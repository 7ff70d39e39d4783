// M4's figure 10: blocks over time.

#include <algorithm>
#include <cmath>

#include "tools/drawing/chart.hpp"
#include "tools/paper_numbers/m4_path.hpp"

namespace kinebus::papers {
namespace {

using drawing::Point;

constexpr const char* kBlockColours[] = {"#29788e", "#e07b39", "#6a4c93"};
constexpr const char* kSingularColour = "#b3261e";

/// A panel whose frame holds all curves.
drawing::Chart draw_panel(drawing::Document& document, const drawing::Box& area, const char* title,
                          double end_s, const std::vector<std::vector<Point>>& curves) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const auto& curve : curves)
    for (const Point& p : curve) {
      low = std::min(low, p.y);
      high = std::max(high, p.y);
    }
  const double step = drawing::round_step(high - low, 6);
  const drawing::Chart chart{area, 0, end_s, step * std::floor(low / step), step * std::ceil(high / step)};
  drawing::draw_frame(document, chart,
                      {.x_step = 0.5, .y_step = step, .title = title, .x_name = "t, s", .y_name = "mm"});
  return chart;
}

}  // namespace

std::string draw_figure10(const M4Geometry& g, const std::vector<double>& crossings_s, const M4Build& other,
                          const std::vector<BlocksAt>& driven) {
  drawing::Document document(1180, 980);
  document.heading(40, "M4: blocks along the path of table 4 (the paper's figure 10)",
                   "x = 200 cos t, y = 100 + 200 sin t mm, phi = -0.3 + 0.2 t. Dashed: y2 with block 2 below "
                   "the tool, which meets no singular pose.");
  std::vector<std::vector<Point>> curves(4), run(3);
  for (int k = 0; k <= 300; ++k) {
    const double t = kM4PathEnd_s * k / 300;
    const auto y = m4_blocks(g, m4_path_at(t), {}), below = m4_blocks(g, m4_path_at(t, other), other);
    if (!y || !below) continue;
    for (std::size_t i = 0; i < 3; ++i) curves[i].push_back({t, (*y)[i]});
    curves[3].push_back({t, (*below)[1]});
  }
  for (std::size_t k = 0; k < driven.size(); k += 10)
    for (std::size_t i = 0; i < 3; ++i) run[i].push_back({driven[k].t_s, driven[k].y_mm[i]});

  const auto paper =
      draw_panel(document, {90, 140, 1040, 330},
                 "The paper's assembly: blocks above the tool, AB level with it", kM4PathEnd_s, curves);
  for (std::size_t i = 0; i < 3; ++i) drawing::draw_curve(document, paper, curves[i], kBlockColours[i], 2.5);
  std::vector<Point> dashed;
  for (const Point& p : curves[3]) dashed.push_back(paper.at(p.x, p.y));
  document.polyline(dashed, {.stroke = kBlockColours[1], .width = 2, .dash = "7 5"});
  for (const double t : crossings_s) {
    const Point top = paper.at(t, paper.y_high);
    document.line(paper.at(t, paper.y_low), top, {.stroke = kSingularColour, .width = 1.5, .dash = "4 4"});
    document.text({top.x + 8, top.y + 18}, printed("singular at t = %.3f s", t),
                  {.fill = kSingularColour, .halo = "white"});
  }
  drawing::draw_legend(document, {1130, 124},
                       std::vector<drawing::LegendEntry>{
                           {"y1", kBlockColours[0]}, {"y2", kBlockColours[1]}, {"y3", kBlockColours[2]}});
  if (driven.empty()) return document.svg();
  const auto machine = draw_panel(document, {90, 580, 1040, 330},
                                  "m4.toml on the same path of the tool, as its simulated motors ran: the "
                                  "triangle turned against the tool",
                                  std::max(kM4PathEnd_s, driven.back().t_s), run);
  for (std::size_t i = 0; i < 3; ++i) drawing::draw_curve(document, machine, run[i], kBlockColours[i], 2.5);
  return document.svg();
}

}  // namespace kinebus::papers
