#include "tools/simulation/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace kinebus {

namespace {

constexpr double kWidth = 1200, kMargin = 70, kSceneHeight = 620, kChartHeight = 170, kGap = 62, kTop = 96;
// Points drawn: enough for any detail that a picture of this size can show.
constexpr std::size_t kDrawnChart = 1'500;

/// Blue over green to yellow (dark to light, also for readers who do not see colours well).
std::string colour(double fraction) {
  struct Stop {
    double r, g, b;
  };
  static constexpr std::array<Stop, 5> kStops{
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {240, 200, 30}}};
  const double x = std::clamp(fraction, 0.0, 0.9999) * 4;
  const auto i = static_cast<std::size_t>(x);
  const double f = x - static_cast<double>(i);
  const auto mix = [&](double a, double b) { return static_cast<int>(std::lround(a + f * (b - a))); };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(kStops[i].r, kStops[i + 1].r),
                     mix(kStops[i].g, kStops[i + 1].g), mix(kStops[i].b, kStops[i + 1].b));
}

/// A round step that divides `range` into about `parts`.
double round_step(double range, int parts) {
  const double raw = std::max(range, 1e-9) / parts;
  const double magnitude = std::pow(10, std::floor(std::log10(raw)));
  for (const double step : {1.0, 2.0, 5.0})
    if (raw <= step * magnitude) return step * magnitude;
  return 10 * magnitude;
}

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
  std::pair<double, double> at(double x, double y, double z) const {
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

void text(std::string& svg, double x, double y, const std::string& words, const char* style) {
  std::string safe;
  for (const char c : words) {
    if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '&')
      safe += "&amp;";
    else
      safe += c;
  }
  svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, style, safe);
}

void line(std::string& svg, std::pair<double, double> a, std::pair<double, double> b, const char* style) {
  svg += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", a.first,
                     a.second, b.first, b.second, style);
}

constexpr const char* kTitle = "font-size=\"24\" font-weight=\"600\" fill=\"#1b1f24\"";
constexpr const char* kHeading = "font-size=\"15\" font-weight=\"600\" fill=\"#1b1f24\"";
constexpr const char* kLabel = "font-size=\"12\" fill=\"#57606a\"";
constexpr const char* kRightLabel = "font-size=\"12\" fill=\"#57606a\" text-anchor=\"end\"";
constexpr const char* kMiddleLabel = "font-size=\"12\" fill=\"#57606a\" text-anchor=\"middle\"";

View make_view(const PlotData& data) {
  View view;
  for (const auto& p : data.points())
    for (std::size_t i = 0; i < 3; ++i) view.box[i].include(p.tool_mm[i]);
  for (std::size_t i = 0; i < 2; ++i) {
    const double step = round_step(view.box[i].span(), 6);
    view.box[i].low = step * std::floor(view.box[i].low / step - 0.2);
    view.box[i].high = step * std::ceil(view.box[i].high / step + 0.2);
  }
  view.box[2].low = std::min(0.0, view.box[2].low);
  view.fit(kMargin, kTop, kWidth - 2 * kMargin - 60, kSceneHeight - 40);
  return view;
}

void draw_bed(std::string& svg, const View& view) {
  const Range x = view.box[0], y = view.box[1], z = view.box[2];
  const auto corner = [&](double a, double b) {
    const auto [u, v] = view.at(a, b, z.low);
    return fmt::format("{:.1f},{:.1f} ", u, v);
  };
  svg += "<polygon points=\"" + corner(x.low, y.low) + corner(x.high, y.low) + corner(x.high, y.high) +
         corner(x.low, y.high) + "\" fill=\"#f6f8fa\" stroke=\"#afb8c1\"/>\n";
  const double sx = round_step(x.span(), 6), sy = round_step(y.span(), 6), sz = round_step(z.span(), 5);
  constexpr const char* kGrid = "stroke=\"#d8dee4\" stroke-width=\"1\"";
  for (double v = x.low; v <= x.high + 1e-6; v += sx) {
    line(svg, view.at(v, y.low, z.low), view.at(v, y.high, z.low), kGrid);
    const auto [u, w] = view.at(v, y.low, z.low);
    text(svg, u - 6, w + 18, fmt::format("{:g}", v), kMiddleLabel);
  }
  for (double v = y.low; v <= y.high + 1e-6; v += sy) {
    line(svg, view.at(x.low, v, z.low), view.at(x.high, v, z.low), kGrid);
    const auto [u, w] = view.at(x.high, v, z.low);
    text(svg, u + 22, w + 8, fmt::format("{:g}", v), kMiddleLabel);
  }
  line(svg, view.at(x.low, y.high, z.low), view.at(x.low, y.high, z.high), "stroke=\"#afb8c1\"");
  for (double v = z.low; v <= z.high + 1e-6; v += sz) {
    const auto [u, w] = view.at(x.low, y.high, v);
    text(svg, u - 8, w + 4, fmt::format("{:g}", v), kRightLabel);
  }
  const auto [xu, xv] = view.at((x.low + x.high) / 2, y.low, z.low);
  text(svg, xu, xv + 38, "X mm", kMiddleLabel);
  const auto [yu, yv] = view.at(x.high, (y.low + y.high) / 2, z.low);
  text(svg, yu + 58, yv + 24, "Y mm", kMiddleLabel);
  const auto [zu, zv] = view.at(x.low, y.high, z.high);
  text(svg, zu - 8, zv - 12, "Z mm", kRightLabel);
}

/// What the path's colour shows: speed, or height where the speed hardly changes.
struct Scale {
  bool height = false;
  double low = 0, high = 1;
  double fraction(const PlotData::PathPoint& p) const {
    return ((height ? p.mm[2] : p.speed_mm_per_s) - low) / (high - low);
  }
};

bool prints(const PlotData::Point& before, const PlotData::Point& now) {
  return now.e_mm > before.e_mm + 1e-6f;
}

Scale make_scale(const PlotData& data) {
  const auto& points = data.points();
  std::vector<float> speeds;
  Range height;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!prints(points[i - 1], points[i])) continue;
    speeds.push_back(points[i].speed_mm_per_s);
    height.include(points[i].tool_mm[2]);
  }
  if (speeds.empty()) return {};
  std::sort(speeds.begin(), speeds.end());
  const double fastest = std::max<double>(speeds.back(), 1), slow = speeds[speeds.size() / 10];
  if (slow > 0.95 * fastest && height.span() > 1) return {true, height.low, height.high};
  return {false, 0, fastest};
}

void draw_path(std::string& svg, const View& view, const PlotData& data, const Scale& scale) {
  constexpr int kBands = 24, kTravel = kBands;
  svg += "<style>path.p{fill:none;stroke-width:1.3;stroke-linejoin:round}";
  for (int i = 0; i < kBands; ++i) svg += fmt::format(".c{}{{stroke:{}}}", i, colour((i + 0.5) / kBands));
  svg += fmt::format("path.c{}{{stroke:#c3cad1;stroke-width:0.6}}</style>\n", kTravel);

  std::string run;
  int band = -1;
  const auto flush = [&] {
    if (!run.empty()) svg += fmt::format("<path class=\"p c{}\" d=\"{}\"/>\n", band, run);
    run.clear();
  };
  for (const PlotData::Stretch& stretch : data.path()) {
    for (std::size_t i = 1; i < stretch.size(); ++i) {
      const auto& a = stretch[i - 1].mm;
      const auto& b = stretch[i];
      const int now =
          b.prints ? static_cast<int>(std::clamp(scale.fraction(b), 0.0, 0.999) * kBands) : kTravel;
      if (now != band) {
        flush();
        band = now;
      }
      if (run.empty()) {
        const auto [u, v] = view.at(a[0], a[1], a[2]);
        run = fmt::format("M{:.1f} {:.1f}", u, v);
      }
      const auto [u, v] = view.at(b.mm[0], b.mm[1], b.mm[2]);
      run += fmt::format("L{:.1f} {:.1f}", u, v);
    }
    flush();
  }
}

void draw_scale(std::string& svg, const Scale& scale) {
  const double x = kWidth - 50, top = kTop + 60, height = 260;
  constexpr int kSteps = 40;
  for (int i = 0; i < kSteps; ++i)
    svg += fmt::format("<rect x=\"{}\" y=\"{:.1f}\" width=\"16\" height=\"{:.1f}\" fill=\"{}\"/>\n", x - 16,
                       top + height * (1 - (i + 1.0) / kSteps), height / kSteps + 0.5,
                       colour((i + 0.5) / kSteps));
  for (int i = 0; i <= 4; ++i)
    text(svg, x - 22, top + height * (1 - i / 4.0) + 4,
         fmt::format("{:.0f}", scale.low + (scale.high - scale.low) * i / 4), kRightLabel);
  text(svg, x + 2, top - 26, scale.height ? "height" : "tool speed", kRightLabel);
  text(svg, x + 2, top - 10, scale.height ? "mm" : "mm/s", kRightLabel);
  line(svg, {x - 16, top + height + 22}, {x, top + height + 22}, "stroke=\"#c3cad1\" stroke-width=\"1.5\"");
  text(svg, x - 22, top + height + 26, "travel", kRightLabel);
}

struct Series {
  std::string name, colour;
  std::function<double(const PlotData::Point&)> value;
  bool peak = false;  ///< draw the largest of the points that share a pixel
};

void draw_chart(std::string& svg, double top, const PlotData& data, const std::string& title,
                const std::vector<Series>& series, bool from_zero) {
  const auto& points = data.points();
  const double left = kMargin, width = kWidth - 2 * kMargin, height = kChartHeight;
  Range range;
  if (from_zero) range.include(0);
  for (const auto& p : points)
    for (const auto& s : series) range.include(s.value(p));
  const double step = round_step(range.span() * 1.05, 4);
  range.low = step * std::floor(range.low / step);
  range.high = step * std::ceil(range.high / step + 1e-9);
  if (range.high <= range.low) range.high = range.low + step;
  const double end = std::max<double>(points.back().time_s, 1e-3);
  const auto px = [&](double t) { return left + width * t / end; };
  const auto py = [&](double v) { return top + height * (1 - (v - range.low) / (range.high - range.low)); };

  text(svg, left, top - 12, title, kHeading);
  for (double v = range.low; v <= range.high + step / 2; v += step) {
    line(svg, {left, py(v)}, {left + width, py(v)}, "stroke=\"#e4e8ec\"");
    text(svg, left - 8, py(v) + 4, fmt::format("{:g}", std::abs(v) < step * 1e-6 ? 0 : v), kRightLabel);
  }
  const double ts = round_step(end, 10);
  for (double t = 0; t <= end + 1e-9; t += ts) {
    line(svg, {px(t), top + height}, {px(t), top + height + 4}, "stroke=\"#afb8c1\"");
    text(svg, px(t), top + height + 18, fmt::format("{:g}", t), kMiddleLabel);
  }
  text(svg, left + width + 12, top + height + 18, "s", kLabel);

  const std::size_t bucket = std::max<std::size_t>(1, points.size() / kDrawnChart);
  double legend = left + width;
  for (auto it = series.rbegin(); it != series.rend(); ++it) {
    if (series.size() < 2) break;
    text(svg, legend, top - 12, it->name, "font-size=\"12\" fill=\"#1b1f24\" text-anchor=\"end\"");
    legend -= 8.0 * static_cast<double>(it->name.size()) + 8;
    line(svg, {legend - 18, top - 16}, {legend, top - 16},
         fmt::format("stroke=\"{}\" stroke-width=\"3\"", it->colour).c_str());
    legend -= 34;
  }
  for (const auto& s : series) {
    std::string d;
    for (std::size_t i = 0; i < points.size(); i += bucket) {
      double v = s.value(points[i]);
      if (s.peak)
        for (std::size_t k = i; k < std::min(points.size(), i + bucket); ++k)
          v = std::max(v, s.value(points[k]));
      d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", px(points[i].time_s), py(v));
    }
    svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.3\"/>\n", d, s.colour);
  }
}

}  // namespace

std::string draw_plot(const PlotData& data, const MachineDescription& machine, const std::string& title,
                      const std::string& summary) {
  const int linear = static_cast<int>(
      std::count_if(machine.joints.begin(), machine.joints.end(),
                    [](const JointDescription& j) { return !j.rotary && j.travel.min < j.travel.max; }));
  const double total = kTop + kSceneHeight + 4 * (kChartHeight + kGap) + 10;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" viewBox=\"0 0 {0} "
      "{1:.0f}\" "
      "font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n",
      kWidth, total);
  text(svg, kMargin, 42, title, kTitle);
  text(svg, kMargin, 68, summary, "font-size=\"14\" fill=\"#57606a\"");
  if (data.points().size() < 2) {
    text(svg, kMargin, 120, "No motion was measured.", kHeading);
    return svg + "</svg>\n";
  }

  const Scale scale = make_scale(data);
  const View view = make_view(data);
  text(svg, kMargin, kTop + 4, "Tool path of the simulated machine", kHeading);
  if (data.drawn_stretch() > 1)
    text(svg, kMargin, kTop + 24, fmt::format("one layer in {} is drawn", data.drawn_stretch()), kLabel);
  draw_bed(svg, view);
  draw_path(svg, view, data, scale);
  draw_scale(svg, scale);

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
  draw_chart(svg, top, data, "Carriages, mm along their rails", carriages, false);
  draw_chart(svg, top + pitch, data, "Tool speed, mm/s",
             {{"speed", "#57606a",
               [](const PlotData::Point& p) { return static_cast<double>(p.speed_mm_per_s); }, true}},
             true);
  draw_chart(
      svg, top + 2 * pitch, data, "Tool error against the planned pose at equal path time, um",
      {{"error", "#cf222e", [](const PlotData::Point& p) { return static_cast<double>(p.error_um); }, true}},
      true);
  draw_chart(svg, top + 3 * pitch, data, "Bus load, % of 1 Mbit/s",
             {{"load", "#8250df",
               [](const PlotData::Point& p) { return 100.0 * static_cast<double>(p.bus_load); }, true}},
             true);
  return svg + "</svg>\n";
}

}  // namespace kinebus
