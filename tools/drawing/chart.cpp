#include "tools/drawing/chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace kinebus::drawing {

double round_step(double range, int parts) {
  // Rounding must not turn 0.2 * 5 into a range that 0.2 does not divide into 5.
  const double raw = std::max(range, 1e-9) / parts * (1 - 1e-9);
  const double magnitude = std::pow(10, std::floor(std::log10(raw)));
  for (const double step : {1.0, 2.0, 5.0})
    if (raw <= step * magnitude) return step * magnitude;
  return 10 * magnitude;
}

std::vector<double> ticks(double low, double high, double step) {
  std::vector<double> out;
  constexpr double kSpare = 1e-6;  // of a step: rounding leaves no end out
  constexpr int kMost = 1000;
  const double first = std::ceil(low / step - kSpare);
  for (int k = 0; k < kMost && (first + k) * step <= high + kSpare * step; ++k)
    out.push_back((first + k) * step);
  return out;
}

std::string tick_words(double value, double step) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", std::abs(value) < 1e-6 * step ? 0.0 : value);
  return text;
}

Point Chart::at(double x, double y) const {
  return {area.x + area.width * (x - x_low) / (x_high - x_low),
          area.bottom() - area.height * (y - y_low) / (y_high - y_low)};
}

void draw_frame(Document& document, const Chart& chart, const ChartFrame& frame) {
  const Box& a = chart.area;
  document.text({a.x, a.y - 12}, frame.title, {.size = 15, .bold = true});
  for (const double v : ticks(chart.y_low, chart.y_high, frame.y_step)) {
    const double y = chart.at(0, v).y;
    const bool zero = std::abs(v) < 1e-6 * frame.y_step;
    if (frame.grid)
      document.line({a.x, y}, {a.right(), y}, {.stroke = zero ? "#8a949e" : kGrid, .width = 1});
    else
      document.line({a.x - 5, y}, {a.x, y}, {.stroke = kInk, .width = 1});
    document.text({a.x - 8, y + 4}, tick_words(v / frame.y_unit, frame.y_step / frame.y_unit),
                  {.size = 12, .anchor = Anchor::kEnd, .fill = kMuted});
  }
  document.line({a.x, a.bottom()}, {a.right(), a.bottom()}, {.stroke = "#8a949e", .width = 1});
  for (const double v : ticks(chart.x_low, chart.x_high, frame.x_step)) {
    const double x = chart.at(v, 0).x;
    document.line({x, a.bottom()}, {x, a.bottom() + 4}, {.stroke = "#8a949e", .width = 1});
    document.text({x, a.bottom() + 18}, tick_words(v, frame.x_step),
                  {.size = 12, .anchor = Anchor::kMiddle, .fill = kMuted});
  }
  document.text({a.x + a.width / 2, a.bottom() + 36}, frame.x_name, {.anchor = Anchor::kMiddle});
  if (!frame.y_name.empty())
    document.text({a.x - 50, a.y + a.height / 2}, frame.y_name, {.anchor = Anchor::kMiddle, .upwards = true});
}

void draw_curve(Document& document, const Chart& chart, std::span<const Point> values,
                std::string_view colour, double width) {
  std::vector<Point> points;
  points.reserve(values.size());
  for (const Point& v : values) points.push_back(chart.at(v.x, v.y));
  document.polyline(points, {.stroke = colour, .width = width, .round = true});
}

void draw_points(Document& document, const Chart& chart, std::span<const Point> values,
                 std::string_view colour) {
  const auto group = document.group({.fill = colour, .fill_opacity = 0.75});
  for (const Point& v : values)
    document.circle(chart.at(v.x, std::clamp(v.y, chart.y_low, chart.y_high)), 2.2, {});
}

void draw_legend(Document& document, Point end, std::span<const LegendEntry> entries) {
  for (auto it = entries.rbegin(); it != entries.rend(); ++it) {
    const LegendEntry& entry = *it;
    document.text(end, entry.words, {.size = 12, .anchor = Anchor::kEnd});
    end.x -= text_width(entry.words, 12) + 8;
    document.line({end.x - 18, end.y - 4}, {end.x, end.y - 4}, {.stroke = entry.colour, .width = 3});
    end.x -= 34;
  }
}

double text_width(std::string_view words, double size) {
  const auto characters = std::count_if(
      words.begin(), words.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
  return 0.6 * size * static_cast<double>(characters);
}

}  // namespace kinebus::drawing
