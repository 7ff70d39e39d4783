#include "tools/calibrate/residual_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "gateway/calibration/robust.hpp"

namespace kinebus {
namespace {

constexpr const char* kBefore = "#e07b39";
constexpr const char* kAfter = "#29788e";

void put(std::string& out, const char* format, auto... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  out += text;
}

/// 1, 2 or 5 times a power of ten, at least `x`.
double nice(double x) {
  if (!(x > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(x)));
  for (const double m : {1.0, 2.0, 5.0, 10.0})
    if (m * power >= x * (1 - 1e-9)) return m * power;
  return 10 * power;
}

struct Axes {
  double x, y, w, h, low, high, most;
  double px(double v) const { return x + w * (v - low) / (high - low); }
  double py(double v) const { return y + h / 2 - h / 2 * v / most; }
};

void frame(std::string& out, const Axes& a, const std::string& x_name) {
  for (int k = -2; k <= 2; ++k) {
    const double v = a.most * k / 2;
    put(out, "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='%s'/>\n", a.x, a.py(v), a.x + a.w,
        a.py(v), k == 0 ? "#8a949e" : "#e4e8ec");
    put(out, "<text x='%.1f' y='%.1f' text-anchor='end' font-size='12'>%g</text>\n", a.x - 8, a.py(v) + 4,
        1000 * v);
  }
  const double step = nice((a.high - a.low) / 7);
  for (double v = std::ceil(a.low / step) * step; v <= a.high + 1e-9; v += step)
    put(out, "<text x='%.1f' y='%.1f' text-anchor='middle' font-size='12'>%g</text>\n", a.px(v),
        a.y + a.h + 18, v);
  put(out, "<text x='%.1f' y='%.1f' text-anchor='middle' font-size='13'>%s</text>\n", a.x + a.w / 2,
      a.y + a.h + 36, x_name.c_str());
}

void points(std::string& out, const Axes& a, const std::vector<double>& x, const std::vector<double>& y,
            const char* colour) {
  put(out, "<g fill='%s' fill-opacity='0.75'>\n", colour);
  for (std::size_t k = 0; k < x.size() && k < y.size(); ++k)
    put(out, "<circle cx='%.1f' cy='%.1f' r='2.2'/>\n", a.px(x[k]), a.py(std::clamp(y[k], -a.most, a.most)));
  out += "</g>\n";
}

double largest(const std::vector<double>& v) {
  double most = 0;
  for (const double x : v) most = std::max(most, std::abs(x));
  return most;
}

}  // namespace

std::string draw_residuals(const std::string& title, const std::string& subtitle,
                           const std::vector<ResidualPanel>& panels) {
  std::string out;
  const double row = 300, height = 110 + row * static_cast<double>(panels.size());
  put(out,
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1280 %.0f' width='1280' height='%.0f' "
      "font-family='DejaVu Sans, Helvetica, Arial, sans-serif' fill='#1d2733'>\n"
      "<rect width='100%%' height='100%%' fill='white'/>\n",
      height, height);
  put(out, "<text x='40' y='44' font-size='24' font-weight='bold'>%s</text>\n", title.c_str());
  put(out, "<text x='40' y='70' font-size='14' fill='#5a6672'>%s</text>\n", subtitle.c_str());
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const ResidualPanel& p = panels[k];
    const double top = 128 + row * static_cast<double>(k);
    const auto [low, high] = std::minmax_element(p.x.begin(), p.x.end());
    if (p.x.empty()) continue;
    const double from = *low, to = *high > *low ? *high : *low + 1;
    put(out, "<text x='100' y='%.1f' font-size='15' font-weight='bold'>%s</text>\n", top - 14,
        p.title.c_str());
    // Left: both on one scale. Right: what is left, enlarged.
    const Axes wide{100, top, 520, 190, from, to, nice(std::max(largest(p.before_mm), 1e-6))};
    const Axes close{740, top, 500, 190, from, to, nice(std::max(largest(p.after_mm), 1e-6))};
    frame(out, wide, p.x_name);
    frame(out, close, p.x_name);
    points(out, wide, p.x, p.before_mm, kBefore);
    points(out, wide, p.x, p.after_mm, kAfter);
    points(out, close, p.x, p.after_mm, kAfter);
    put(out, "<text x='620' y='%.1f' text-anchor='end' font-size='13' fill='%s'>before: %.1f µm rms</text>\n",
        top - 14, kBefore, 1000 * rms_of(p.before_mm));
    put(out,
        "<text x='1240' y='%.1f' text-anchor='end' font-size='13' fill='%s'>after, enlarged: %.1f µm "
        "rms</text>\n",
        top - 14, kAfter, 1000 * rms_of(p.after_mm));
    put(out, "<text x='46' y='%.1f' font-size='13' text-anchor='middle'>µm</text>\n", top + 99);
    put(out, "<text x='686' y='%.1f' font-size='13' text-anchor='middle'>µm</text>\n", top + 99);
  }
  return out + "</svg>\n";
}

}  // namespace kinebus
