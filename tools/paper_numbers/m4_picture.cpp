// The assemblies of M4's table 6, side by side.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "gateway/kinematics/m4.hpp"
#include "tools/paper_numbers/numbers.hpp"

namespace kinebus::papers {
namespace {

void print(std::string& out, const char* format, auto... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  out += text;
}

}  // namespace

std::string draw_m4_assemblies() {
  const M4Geometry g;
  const Vector3 inputs{932.6, 1029.4, 283.4};
  auto found = m4_assemblies(g, inputs);
  std::erase_if(found, [](const M4Assembly& a) { return !a.block_above[0] || !a.block_above[1]; });
  if (found.size() > 4) found.resize(4);
  constexpr double kPanel = 310, kScale = 0.285;
  std::string out;
  print(out,
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1300 560' width='1300' height='560' "
        "font-family='DejaVu Sans, Helvetica, Arial, sans-serif' fill='#1d2733'>\n"
        "<rect width='100%%' height='100%%' fill='white'/>\n"
        "<text x='40' y='44' font-size='24' font-weight='bold'>Assemblies of M4 for y1 = 932.6, y2 = 1029.4, "
        "y3 = 283.4 mm</text>\n"
        "<text x='40' y='70' font-size='14' fill='#5a6672'>Blocks above the tool. Two are the real "
        "machine's; two need "
        "the triangle mirrored (C on the other side of AB).</text>\n");
  for (std::size_t k = 0; k < found.size(); ++k) {
    const M4Assembly& a = found[k];
    const double cx = 30 + kPanel * (static_cast<double>(k) + 0.5) + 5, bottom = 430;
    const auto x_of = [&](double x) { return cx + kScale * x; };
    const auto y_of = [&](double y) { return bottom - kScale * y; };
    const char* stroke = a.mirrored ? "#e07b39" : "#29788e";
    const double c = std::cos(a.pose.phi_rad), s = std::sin(a.pose.phi_rad), l = g.triangle_mm / 2;
    const double height = (a.mirrored ? -1 : 1) * std::sqrt(3.0) * l;
    const double px[3] = {a.pose.x_mm - l * c, a.pose.x_mm + l * c, a.pose.x_mm - height * s};
    const double py[3] = {a.pose.y_mm - l * s, a.pose.y_mm + l * s, a.pose.y_mm + height * c};
    for (const double side : {-1.0, 1.0})
      print(out,
            "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#c9d1d9' stroke-width='6' "
            "stroke-linecap='round'/>\n",
            x_of(side * g.rails_mm / 2), y_of(0), x_of(side * g.rails_mm / 2), y_of(1150));
    print(out, "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#c9d1d9' stroke-dasharray='5 5'/>\n",
          x_of(-g.rails_mm / 2), y_of(inputs[2]), x_of(g.rails_mm / 2), y_of(inputs[2]));
    for (std::size_t i = 0; i < 2; ++i) {
      const double rail = (i == 0 ? -1 : 1) * g.rails_mm / 2;
      print(out, "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#5a6672' stroke-width='3'/>\n",
            x_of(rail), y_of(inputs[i]), x_of(px[i]), y_of(py[i]));
      print(out, "<rect x='%.1f' y='%.1f' width='18' height='26' rx='3' fill='#1d2733'/>\n", x_of(rail) - 9,
            y_of(inputs[i]) - 13);
    }
    print(out,
          "<path d='M%.1f %.1fL%.1f %.1fL%.1f %.1fz' fill='%s' fill-opacity='0.35' stroke='%s' "
          "stroke-width='3' stroke-linejoin='round'/>\n",
          x_of(px[0]), y_of(py[0]), x_of(px[1]), y_of(py[1]), x_of(px[2]), y_of(py[2]), stroke, stroke);
    constexpr const char* kNames[] = {"A", "B", "C"};
    const double mx = (px[0] + px[1] + px[2]) / 3, my = (py[0] + py[1] + py[2]) / 3;
    for (std::size_t i = 0; i < 3; ++i)
      print(out, "<text x='%.1f' y='%.1f' font-size='13' text-anchor='middle'>%s</text>\n",
            x_of(mx + 1.55 * (px[i] - mx)), y_of(my + 1.55 * (py[i] - my)) + 5, kNames[i]);
    print(
        out,
        "<text x='%.1f' y='478' font-size='15' font-weight='bold' text-anchor='middle' fill='%s'>%s</text>\n",
        cx, stroke, a.mirrored ? "mirrored triangle" : "the real machine");
    print(
        out,
        "<text x='%.1f' y='502' font-size='13' text-anchor='middle'>phi %.2f deg, x %.2f, y %.2f mm</text>\n",
        cx, a.pose.phi_rad / kRadPerDeg, a.pose.x_mm, a.pose.y_mm);
    print(
        out,
        "<text x='%.1f' y='524' font-size='12' text-anchor='middle' fill='#5a6672'>residual %.0e mm</text>\n",
        cx, std::max(a.residual_mm, 1e-14));
  }
  return out + "</svg>\n";
}

}  // namespace kinebus::papers
