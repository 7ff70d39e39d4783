#include "tools/simulation/ringing_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "tools/drawing/chart.hpp"

namespace kinebus {
namespace {

using drawing::Point;
using TracePoint = RingingTrace::Point;

constexpr double kHalf_mm = 4, kEnlarged = 30, kAround_s = 0.15;
constexpr std::string_view kBefore = "#c0392b", kAfter = "#29788e";

double deviation_um(const TracePoint& p) {
  return std::hypot(p.dx_um, p.dy_um, p.dz_um);
}

/// Samples of up to kAround_s before and behind `at`.
std::span<const TracePoint> around(const RingingTrace& trace, std::size_t at) {
  const auto reach = static_cast<std::size_t>(kAround_s / trace.period_s);
  const std::size_t from = at > reach ? at - reach : 0, to = std::min(trace.points.size(), at + 2 * reach);
  return {trace.points.data() + from, to - from};
}

/// The sample of another run that is nearest to `p` on the same line of the job, or about it.
std::size_t same_place(const RingingTrace& trace, const TracePoint& p) {
  std::size_t best = 0;
  double least = 1e30;
  for (std::size_t i = 0; i < trace.points.size(); ++i) {
    const TracePoint& q = trace.points[i];
    if (q.line + 1 < p.line || q.line > p.line + 1) continue;
    const double far = std::hypot(q.x_mm - p.x_mm, q.y_mm - p.y_mm, q.z_mm - p.z_mm);
    if (far >= least) continue;
    least = far;
    best = i;
  }
  return best;
}

void draw_corner(drawing::Document& document, const drawing::Box& box, std::span<const TracePoint> points,
                 const TracePoint& centre, std::string_view words, std::string_view colour) {
  const double scale = box.width / (2 * kHalf_mm);
  std::vector<Point> planned, swinging;
  for (const TracePoint& p : points) {
    const auto at = [&](double dx_um, double dy_um) {
      return Point{box.x + scale * (p.x_mm + 1e-3 * dx_um - centre.x_mm + kHalf_mm),
                   box.y + scale * (kHalf_mm - (p.y_mm + 1e-3 * dy_um - centre.y_mm))};
    };
    planned.push_back(at(0, 0));
    swinging.push_back(at(kEnlarged * p.dx_um, kEnlarged * p.dy_um));
  }
  document.text({box.x, box.y - 10}, words, {.size = 15, .bold = true});
  document.rectangle(box, {.fill = "none", .stroke = drawing::kFaint, .width = 1});
  const auto inside = document.clipped(box, 0);
  document.polyline(planned, {.stroke = drawing::kMuted, .width = 1, .dash = "3 3"});
  document.polyline(swinging, {.stroke = colour, .width = 2, .round = true});
}

}  // namespace

std::string draw_ringing(const RingingTrace& unshaped, const RingingTrace& shaped, const std::string& title) {
  drawing::Document document(1100, 860);
  const auto worst = std::max_element(
      unshaped.points.begin(), unshaped.points.end(),
      [](const TracePoint& a, const TracePoint& b) { return deviation_um(a) < deviation_um(b); });
  if (worst == unshaped.points.end()) {
    document.heading(40, title, "nothing moved");
    return document.svg();
  }
  const auto at = static_cast<std::size_t>(worst - unshaped.points.begin());
  document.heading(
      40, title,
      fmt::format(
          "The corner at line {} where the tool swung most; deviations {:.0f} times enlarged, {:g} mm across",
          worst->line, kEnlarged, 2 * kHalf_mm));
  const auto before = around(unshaped, at);
  draw_corner(document, {60, 140, 460, 460}, before, *worst, "without shaping", kBefore);
  std::span<const TracePoint> after;
  if (!shaped.points.empty()) after = around(shaped, same_place(shaped, *worst));
  draw_corner(document, {580, 140, 460, 460}, after, *worst,
              shaped.points.empty() ? "[vibration] shapes nothing" : "shaped", kAfter);
  const double highest = deviation_um(*worst), step = drawing::round_step(highest, 4);
  const drawing::Chart chart{.area = {90, 660, 950, 130},
                             .x_low = 0,
                             .x_high = 1e3 * unshaped.period_s * static_cast<double>(before.size()),
                             .y_low = 0,
                             .y_high = step * std::ceil(highest / step)};
  drawing::draw_frame(
      document, chart,
      {.x_step = 50, .y_step = step, .title = "off the motors' path", .x_name = "ms", .y_name = "um"});
  const auto curve = [&](std::span<const TracePoint> points, double period_s, std::string_view colour) {
    std::vector<Point> values;
    for (std::size_t i = 0; i < points.size() && 1e3 * period_s * static_cast<double>(i) <= chart.x_high; ++i)
      values.push_back({1e3 * period_s * static_cast<double>(i), deviation_um(points[i])});
    drawing::draw_curve(document, chart, values, colour, 1.5);
  };
  curve(before, unshaped.period_s, kBefore);
  curve(after, shaped.period_s, kAfter);
  return document.svg();
}

}  // namespace kinebus
