#include "tools/heat_study/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/drawing/chart.hpp"

namespace kinebus::heat_study {
namespace {

using drawing::Point;

constexpr std::array<std::string_view, kControls.size()> kColours{"#b3261e", "#e07b39", "#29788e"};
constexpr double kTick_s = 10;

std::vector<Point> curve_of(const Run& run, double Sample::*value) {
  std::vector<Point> points;
  for (const Sample& sample : run.samples) points.push_back({sample.t_s, sample.*value});
  return points;
}

}  // namespace

std::string draw_flow_step(const Scene& scene, const std::array<Run, kControls.size()>& runs) {
  drawing::Document document(1100, 760);
  document.heading(
      40, "A step of filament through a hot end",
      fmt::format("0 to {:.0f} mm³/s and back at {:.0f} °C  44 W, 14.6 J/K, dead time 1.6 s  the "
                  "master believes {:.0f} % of the filament's heat",
                  scene.flow_mm3_per_s, scene.target_c, 100 * scene.filament_j_per_mm3_k / 0.0023));
  const double end_s = scene.flowing_s + scene.after_s;
  double low = 0, high = 0;
  for (const Run& run : runs) {
    low = std::min(low, run.lowest_k);
    high = std::max(high, run.highest_k);
  }
  const double step = drawing::round_step(high - low, 8);
  const drawing::Chart block{{90, 150, 970, 330},
                             -scene.before_s,
                             end_s,
                             step * std::floor(low / step),
                             step * std::ceil(high / step)};
  drawing::draw_frame(
      document, block,
      {.x_step = kTick_s, .y_step = step, .title = "The block, off its target", .y_name = "K"});
  const drawing::Chart power{{90, 540, 970, 150}, -scene.before_s, end_s, 0, 45};
  drawing::draw_frame(document, power,
                      {.x_step = kTick_s, .y_step = 15, .title = "Power", .x_name = "t, s", .y_name = "W"});
  std::vector<drawing::LegendEntry> legend;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    drawing::draw_curve(document, block, curve_of(runs[i], &Sample::off_k), kColours[i], 2.2);
    drawing::draw_curve(document, power, curve_of(runs[i], &Sample::power_w), kColours[i], 1.2);
    legend.push_back({std::string(words(kControls[i])), kColours[i]});
  }
  drawing::draw_legend(document, {1060, 134}, legend);
  return document.svg();
}

}  // namespace kinebus::heat_study
