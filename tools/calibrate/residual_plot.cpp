#include "tools/calibrate/residual_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/calibrate/fit/robust.hpp"
#include "tools/drawing/chart.hpp"

namespace kinebus {
namespace {

using drawing::Chart;
using drawing::Point;

constexpr const char* kBefore = "#e07b39";
constexpr const char* kAfter = "#29788e";
constexpr double kRow = 300;

std::string rms_words(const char* of_what, const std::vector<double>& residuals_mm) {
  char text[64];
  std::snprintf(text, sizeof text, "%s: %.1f µm rms", of_what, 1000 * rms_of(residuals_mm));
  return text;
}

/// As high as the largest of them, rounded up, both ways.
Chart chart_for(const drawing::Box& area, const ResidualPanel& p, const std::vector<double>& residuals_mm) {
  const auto [low, high] = std::minmax_element(p.x.begin(), p.x.end());
  double most = 1e-6;
  for (const double r : residuals_mm) most = std::max(most, std::abs(r));
  const double top = drawing::round_step(most, 1);
  return {
      .area = area, .x_low = *low, .x_high = *high > *low ? *high : *low + 1, .y_low = -top, .y_high = top};
}

void points(drawing::Document& document, const Chart& chart, const std::vector<double>& x,
            const std::vector<double>& residuals_mm, const char* colour) {
  std::vector<Point> values;
  for (std::size_t k = 0; k < x.size() && k < residuals_mm.size(); ++k)
    values.push_back({x[k], residuals_mm[k]});
  drawing::draw_points(document, chart, values, colour);
}

void panel(drawing::Document& document, const ResidualPanel& p, double top) {
  // Left: both on one scale. Right: what is left, enlarged.
  const Chart wide = chart_for({100, top, 520, 190}, p, p.before_mm),
              close = chart_for({740, top, 500, 190}, p, p.after_mm);
  const double step = drawing::round_step(wide.x_high - wide.x_low, 7);
  const auto frame = [&](const Chart& chart, std::string_view title) {
    drawing::draw_frame(document, chart,
                        {.x_step = step,
                         .y_step = chart.y_high / 2,
                         .title = title,
                         .x_name = p.x_name,
                         .y_name = "µm",
                         .y_unit = 1e-3});
  };
  frame(wide, p.title);
  frame(close, "");
  points(document, wide, p.x, p.before_mm, kBefore);
  points(document, wide, p.x, p.after_mm, kAfter);
  points(document, close, p.x, p.after_mm, kAfter);
  const auto words = [&](const Chart& chart, const std::string& text, const char* colour) {
    document.text({chart.area.right(), top - 12}, text, {.anchor = drawing::Anchor::kEnd, .fill = colour});
  };
  words(wide, rms_words("before", p.before_mm), kBefore);
  words(close, rms_words("after, enlarged", p.after_mm), kAfter);
}

}  // namespace

std::string draw_residuals(const std::string& title, const std::string& subtitle,
                           const std::vector<ResidualPanel>& panels) {
  drawing::Document document(1280, 110 + kRow * static_cast<double>(panels.size()));
  document.heading(40, title, subtitle);
  for (std::size_t k = 0; k < panels.size(); ++k)
    if (!panels[k].x.empty()) panel(document, panels[k], 128 + kRow * static_cast<double>(k));
  return document.svg();
}

}  // namespace kinebus
