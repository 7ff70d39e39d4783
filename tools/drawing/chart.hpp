#pragma once
// Values over values: a frame with round numbers at its ticks, curves and points in it, a legend.

#include <span>
#include <string>
#include <vector>

#include "tools/drawing/document.hpp"

namespace kinebus::drawing {

/// 1, 2 or 5 times a power of ten: the smallest that divides `range` into no more than `parts`.
double round_step(double range, int parts);

/// The multiples of `step` from low to high, the ends included.
std::vector<double> ticks(double low, double high, double step);

/// As a person writes it: "0.2", "1500", never "-0" or "2.7755e-17" where a tick is meant to be 0.
std::string tick_words(double value, double step);

struct Chart {
  Box area;
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;
  Point at(double x, double y) const;
};

struct ChartFrame {
  double x_step = 1, y_step = 1;
  std::string_view title{};             ///< above, at the left
  std::string_view x_name{}, y_name{};  ///< below; at the left, turned
  double y_unit = 1;                    ///< what is written at a tick is its value over this
  bool grid = true;
};
void draw_frame(Document& document, const Chart& chart, const ChartFrame& frame);

/// `values`: x and y of each point, in the chart's own values.
void draw_curve(Document& document, const Chart& chart, std::span<const Point> values,
                std::string_view colour, double width);
/// What is beyond the frame is drawn on its edge.
void draw_points(Document& document, const Chart& chart, std::span<const Point> values,
                 std::string_view colour);

struct LegendEntry {
  std::string words;
  std::string_view colour;
};
/// In one row that ends at `end`.
void draw_legend(Document& document, Point end, std::span<const LegendEntry> entries);

/// About, in the picture's font; characters of UTF-8 counted once.
double text_width(std::string_view words, double size);

}  // namespace kinebus::drawing
