#include "tools/simulation/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "tools/drawing/chart.hpp"
#include "tools/drawing/colour.hpp"

namespace kinebus {

namespace {

using drawing::Anchor;
using drawing::Document;
using drawing::Point;
using drawing::round_step;

constexpr double kWidth = 1200, kMargin = 70, kSceneHeight = 620, kChartHeight = 170, kGap = 66, kTop = 96;
constexpr const char* kTravelColour = "#c3cad1";
// Points drawn: enough for any detail that a picture of this size can show.
constexpr std::size_t kDrawnChart = 1'500;
// Of a step: what is full ends at 100 %, however a float says it.
constexpr double kOnTheLine = 1e-6;

struct Range {
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  void include(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  double span() const { return std::max(high - low, 1e-9); }
};

/// Axonometric view from the front left, Z up.
struct View {
  std::array<Range, 3> box;
  double scale = 1, x0 = 0, y0 = 0;

  static std::pair<double, double> project(double x, double y, double z) {
    constexpr double kTurn = 35 * std::numbers::pi / 180, kTilt = 28 * std::numbers::pi / 180;
    const double right = x * std::cos(kTurn) + y * std::sin(kTurn);
    const double deep = -x * std::sin(kTurn) + y * std::cos(kTurn);
    return {right, -(z * std::cos(kTilt) + deep * std::sin(kTilt))};
  }
  Point at(double x, double y, double z) const {
    const auto [u, v] = project(x, y, z);
    return {x0 + scale * u, y0 + scale * v};
  }
  void fit(double left, double top, double width, double height) {
    Range u, v;
    for (const double x : {box[0].low, box[0].high})
      for (const double y : {box[1].low, box[1].high})
        for (const double z : {box[2].low, box[2].high}) {
          const auto [pu, pv] = project(x, y, z);
          u.include(pu);
          v.include(pv);
        }
    scale = std::min(width / u.span(), height / v.span());
    x0 = left + width / 2 - scale * (u.low + u.high) / 2;
    y0 = top + height / 2 - scale * (v.low + v.high) / 2;
  }
};

const drawing::TextStyle kLabel{.size = 12, .fill = drawing::kMuted},
    kRightLabel{.size = 12, .anchor = Anchor::kEnd, .fill = drawing::kMuted},
    kMiddleLabel{.size = 12, .anchor = Anchor::kMiddle, .fill = drawing::kMuted};

/// Of the lines on the table, along X and Y alike.
double step_on_table(const View& view) {
  return round_step(std::max(view.box[0].span(), view.box[1].span()), 6);
}

View make_view(const PlotData& data) {
  View view;
  for (const auto& p : data.points())
    for (std::size_t i = 0; i < 3; ++i) view.box[i].include(p.tool_mm[i]);
  for (std::size_t i = 0; i < 2; ++i) {
    // What lies in a plane (turning) is drawn on a strip of the table.
    const double middle = (view.box[i].low + view.box[i].high) / 2, least = 2;
    if (view.box[i].span() < least) view.box[i] = {middle - least / 2, middle + least / 2};
  }
  const double step = step_on_table(view);
  for (std::size_t i = 0; i < 2; ++i) {
    view.box[i].low = step * std::floor(view.box[i].low / step - 0.2);
    view.box[i].high = step * std::ceil(view.box[i].high / step + 0.2);
  }
  view.box[2].low = std::min(0.0, view.box[2].low);
  view.fit(kMargin, kTop + 34, kWidth - 2 * kMargin - 60, kSceneHeight - 74);
  return view;
}

void draw_bed(Document& document, const View& view) {
  const Range x = view.box[0], y = view.box[1], z = view.box[2];
  const auto at = [&](double a, double b) { return view.at(a, b, z.low); };
  const std::array<Point, 4> corners{at(x.low, y.low), at(x.high, y.low), at(x.high, y.high),
                                     at(x.low, y.high)};
  document.polygon(corners, {.fill = "#f6f8fa", .stroke = "#afb8c1"});
  const double step = step_on_table(view), sz = round_step(z.span(), 5);
  const drawing::Style grid{.stroke = "#d8dee4", .width = 1};
  for (const double v : drawing::ticks(x.low, x.high, step)) {
    const Point p = at(v, y.low);
    document.line(p, at(v, y.high), grid);
    document.text({p.x - 6, p.y + 18}, drawing::tick_words(v, step), kMiddleLabel);
  }
  for (const double v : drawing::ticks(y.low, y.high, step)) {
    const Point p = at(x.high, v);
    document.line(at(x.low, v), p, grid);
    document.text({p.x + 22, p.y + 8}, drawing::tick_words(v, step), kMiddleLabel);
  }
  document.line(at(x.low, y.high), view.at(x.low, y.high, z.high), {.stroke = "#afb8c1"});
  for (const double v : drawing::ticks(z.low, z.high, sz)) {
    const Point p = view.at(x.low, y.high, v);
    document.text({p.x - 8, p.y + 4}, drawing::tick_words(v, sz), kRightLabel);
  }
  const Point below = at((x.low + x.high) / 2, y.low), beside = at(x.high, (y.low + y.high) / 2),
              above = view.at(x.low, y.high, z.high);
  document.text({below.x, below.y + 38}, "X mm", kMiddleLabel);
  document.text({beside.x + 58, beside.y + 24}, "Y mm", kMiddleLabel);
  document.text({above.x - 8, above.y - 12}, "Z mm", kRightLabel);
}

/// What the path's colour shows: speed, or height where the speed hardly changes.
struct Scale {
  bool height = false;
  double low = 0, high = 1;
  double fraction(const PlotData::PathPoint& p) const {
    return ((height ? p.mm[2] : p.speed_mm_per_s) - low) / (high - low);
  }
};

Scale make_scale(const PlotData& data) {
  const auto& points = data.points();
  std::vector<float> speeds;
  Range height;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (data.prints && !PlotData::feeds(points[i - 1], points[i])) continue;
    speeds.push_back(points[i].speed_mm_per_s);
    height.include(points[i].tool_mm[2]);
  }
  if (speeds.empty()) return {};
  std::sort(speeds.begin(), speeds.end());
  const double fastest = std::max<double>(speeds.back(), 1), slow = speeds[speeds.size() / 10];
  if (slow > 0.95 * fastest && height.span() > 1) return {true, height.low, height.high};
  return {false, 0, fastest};
}

void draw_path(Document& document, const View& view, const PlotData& data, const Scale& scale) {
  constexpr int kBands = 24, kTravel = kBands;
  std::array<std::string, kBands> colours;
  for (int i = 0; i < kBands; ++i)
    colours[static_cast<std::size_t>(i)] = drawing::scale_rgb((i + 0.5) / kBands);
  const auto group = document.group({.width = 1.3, .round = true});
  std::vector<Point> run;
  int band = -1;
  const auto flush = [&] {
    if (band == kTravel)
      document.polyline(run, {.stroke = kTravelColour, .width = 0.6});
    else if (band >= 0)
      document.polyline(run, {.stroke = colours[static_cast<std::size_t>(band)]});
    run.clear();
  };
  for (const PlotData::Stretch& stretch : data.path()) {
    for (std::size_t i = 1; i < stretch.size(); ++i) {
      const auto& a = stretch[i - 1].mm;
      const auto& b = stretch[i];
      const int now = b.prints || !data.prints
                          ? static_cast<int>(std::clamp(scale.fraction(b), 0.0, 0.999) * kBands)
                          : kTravel;
      if (now != band) {
        flush();
        band = now;
      }
      if (run.empty()) run.push_back(view.at(a[0], a[1], a[2]));
      run.push_back(view.at(b.mm[0], b.mm[1], b.mm[2]));
    }
    flush();
  }
}

void draw_scale(Document& document, const Scale& scale, bool with_travel) {
  const double x = kWidth - 50, top = kTop + 60, height = 260;
  drawing::colour_bar(document, {x - 16, top, 16, height});
  // No two of the five say the same.
  const int decimals = scale.high - scale.low < 8 ? 1 : 0;
  for (int i = 0; i <= 4; ++i)
    document.text({x - 22, top + height * (1 - i / 4.0) + 4},
                  fmt::format("{:.{}f}", scale.low + (scale.high - scale.low) * i / 4, decimals),
                  kRightLabel);
  document.text({x + 2, top - 26}, scale.height ? "height" : "tool speed", kRightLabel);
  document.text({x + 2, top - 10}, scale.height ? "mm" : "mm/s", kRightLabel);
  if (!with_travel) return;
  document.line({x - 16, top + height + 22}, {x, top + height + 22}, {.stroke = kTravelColour, .width = 1.5});
  document.text({x - 22, top + height + 26}, "travel", kRightLabel);
}

struct Series {
  std::string name;
  const char* colour;
  std::function<double(const PlotData::Point&)> value;
  bool peak = false;  ///< draw the largest of the points that share a pixel
};

void draw_series(Document& document, double top, const PlotData& data, const std::string& title,
                 const std::vector<Series>& series, bool from_zero) {
  const auto& points = data.points();
  Range range;
  if (from_zero) range.include(0);
  for (const auto& p : points)
    for (const auto& s : series) range.include(s.value(p));
  const double step = round_step(range.span() * 1.05, 4);
  drawing::Chart chart{.area = {kMargin, top, kWidth - 2 * kMargin, kChartHeight},
                       .x_high = std::max<double>(points.back().time_s, 1e-3),
                       .y_low = step * std::floor(range.low / step),
                       .y_high = step * std::ceil(range.high / step - kOnTheLine)};
  if (chart.y_high <= chart.y_low) chart.y_high = chart.y_low + step;
  drawing::draw_frame(
      document, chart,
      {.x_step = round_step(chart.x_high, 10), .y_step = step, .title = title, .x_name = "time, s"});
  if (series.size() > 1) {
    std::vector<drawing::LegendEntry> legend;
    legend.reserve(series.size());
    for (const Series& s : series) legend.push_back({s.name, s.colour});
    drawing::draw_legend(document, {chart.area.right(), top - 12}, legend);
  }
  const std::size_t bucket = std::max<std::size_t>(1, points.size() / kDrawnChart);
  for (const Series& s : series) {
    std::vector<Point> values;
    for (std::size_t i = 0; i < points.size(); i += bucket) {
      double v = s.value(points[i]);
      if (s.peak)
        for (std::size_t k = i; k < std::min(points.size(), i + bucket); ++k)
          v = std::max(v, s.value(points[k]));
      values.push_back({points[i].time_s, v});
    }
    drawing::draw_curve(document, chart, values, s.colour, 1.3);
  }
}

/// Every heater has a colour, its target a lighter one.
void draw_heat(Document& document, double top, const PlotData& data, const MachineDescription& machine) {
  static constexpr std::array<std::array<const char*, 2>, PlotData::kHeaters> kColours{
      {{"#cf222e", "#ffaba8"}, {"#0969da", "#80ccff"}, {"#1a7f37", "#8ddb9d"}, {"#8250df", "#d8b9ff"}}};
  static constexpr std::array<const char*, PlotData::kFans> kFanColours{"#57606a", "#bf8700"};
  std::vector<Series> temperatures, powers;
  for (std::size_t h = 0; h < std::min(machine.heaters.size(), kColours.size()); ++h) {
    const std::string& name = machine.heaters[h].name;
    temperatures.push_back(
        {name + ", target", kColours[h][1], [h](const PlotData::Point& p) { return p.heat.target_c[h]; }});
    temperatures.push_back(
        {name, kColours[h][0], [h](const PlotData::Point& p) { return p.heat.measured_c[h]; }});
    powers.push_back({name, kColours[h][0], [h](const PlotData::Point& p) {
                        return 100.0 * static_cast<double>(p.heat.power[h]);
                      }});
  }
  for (std::size_t f = 0; f < std::min(machine.fans.size(), kFanColours.size()); ++f)
    powers.push_back({"fan " + machine.fans[f].name, kFanColours[f],
                      [f](const PlotData::Point& p) { return 100.0 * static_cast<double>(p.heat.fan[f]); }});
  draw_series(document, top, data, "Temperatures, C: target and measured", temperatures, true);
  draw_series(document, top + kChartHeight + kGap, data, "Heaters' power and fans, % of full", powers, true);
}

}  // namespace

std::string draw_plot(const PlotData& data, const MachineDescription& machine, const std::string& title,
                      const std::string& summary) {
  const int linear = static_cast<int>(
      std::count_if(machine.joints.begin(), machine.joints.end(),
                    [](const JointDescription& j) { return !j.rotary && j.travel.min < j.travel.max; }));
  const int charts = data.heated ? 6 : 4;
  Document document(kWidth, kTop + kSceneHeight + charts * (kChartHeight + kGap) + 10);
  document.heading(kMargin, title, summary);
  const drawing::TextStyle heading{.size = 15, .bold = true};
  if (data.points().size() < 2) {
    document.text({kMargin, 120}, "No motion was measured.", heading);
    return document.svg();
  }

  const Scale scale = make_scale(data);
  const View view = make_view(data);
  document.text({kMargin, kTop + 4}, "Tool path of the simulated machine", heading);
  if (data.drawn_stretch() > 1)
    document.text({kMargin, kTop + 24}, fmt::format("one layer in {} is drawn", data.drawn_stretch()),
                  kLabel);
  draw_bed(document, view);
  draw_path(document, view, data, scale);
  draw_scale(document, scale, data.prints);

  static constexpr std::array<const char*, 4> kColours{"#0969da", "#bf3989", "#1a7f37", "#bc4c00"};
  std::vector<Series> carriages;
  for (std::size_t j = 0;
       j < machine.joints.size() && static_cast<int>(carriages.size()) < std::min(linear, 4); ++j) {
    if (machine.joints[j].rotary || machine.joints[j].travel.min >= machine.joints[j].travel.max) continue;
    carriages.push_back({machine.joints[j].name, kColours[carriages.size()],
                         [j](const PlotData::Point& p) { return static_cast<double>(p.joints[j]); }});
  }
  double top = kTop + kSceneHeight + 20;
  const double pitch = kChartHeight + kGap;
  draw_series(document, top, data, "Carriages, mm along their rails", carriages, false);
  draw_series(document, top + pitch, data, "Tool speed, mm/s",
              {{"speed", "#57606a",
                [](const PlotData::Point& p) { return static_cast<double>(p.speed_mm_per_s); }, true}},
              true);
  draw_series(
      document, top + 2 * pitch, data, "Tool error against the planned pose at equal path time, um",
      {{"error", "#cf222e", [](const PlotData::Point& p) { return static_cast<double>(p.error_um); }, true}},
      true);
  draw_series(document, top + 3 * pitch, data, "Bus load, % of 1 Mbit/s",
              {{"load", "#8250df",
                [](const PlotData::Point& p) { return 100.0 * static_cast<double>(p.bus_load); }, true}},
              true);
  if (data.heated) draw_heat(document, top + 4 * pitch, data, machine);
  return document.svg();
}

}  // namespace kinebus
