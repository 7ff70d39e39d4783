// M4: tables 4 and 6.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "gateway/kinematics/m4.hpp"
#include "tools/paper_numbers/numbers.hpp"

namespace kinebus::papers {
namespace {

struct Printed {
  double phi_deg, y_mm, x_mm;
  bool mirrored;
  double turned_deg;  ///< what the print left out
};
constexpr Printed kTable6[] = {{36.5, 163, -7.1, false, 0},
                               {115.27, 219.5, -49.7, true, 0},
                               {-249.91, 232, 248.8, false, 180},
                               {77.46, 250.9, 221, true, 180}};
constexpr Vector3 kInputs{932.6, 1029.4, 283.4};

void table6(Table& t) {
  const auto found = m4_assemblies({}, kInputs);
  for (const Printed& p : kTable6) {
    const double phi = std::remainder((p.phi_deg + p.turned_deg) * kRadPerDeg, 2 * std::numbers::pi);
    const M4Assembly* nearest = nullptr;
    const auto distance = [&](const M4Assembly& a) {
      return std::hypot(a.pose.x_mm - p.x_mm, a.pose.y_mm - p.y_mm,
                        100 * std::remainder(a.pose.phi_rad - phi, 2 * std::numbers::pi));
    };
    for (const M4Assembly& a : found)
      if (a.mirrored == p.mirrored && (nearest == nullptr || distance(a) < distance(*nearest))) nearest = &a;
    if (nearest == nullptr) {
      t.above("an assembly for a printed row", 1, 0, "");
      continue;
    }
    char name[96];
    std::snprintf(name, sizeof name, "row (%.2f, %.1f, %.1f)%s%s", p.phi_deg, p.y_mm, p.x_mm,
                  p.turned_deg != 0 ? ", 180 deg added" : "", p.mirrored ? ", mirrored triangle" : "");
    t.note(name);
    t.compare("    phi", phi / kRadPerDeg, nearest->pose.phi_rad / kRadPerDeg, 0.05, "deg");
    t.compare("    yp", p.y_mm, nearest->pose.y_mm, 0.1, "mm");
    t.compare("    xp", p.x_mm, nearest->pose.x_mm, 0.1, "mm");
    t.below("    residual by substitution", 1e-9, nearest->residual_mm, "mm");
  }
  std::printf("  all %zu assemblies:      phi deg        yp mm        xp mm   residual\n", found.size());
  for (const M4Assembly& a : found)
    std::printf("    %-22s %10.4f %12.4f %12.4f   %.1e mm\n",
                a.mirrored     ? "mirrored triangle"
                : a.physical() ? "the real machine"
                               : "a block below its tool",
                a.pose.phi_rad / kRadPerDeg, a.pose.y_mm, a.pose.x_mm, a.residual_mm);
}

void table4(Table& t) {
  const M4Geometry g;
  double closure = 0, back = 0;
  double previous = 0, crossing = -1;
  for (int k = 0; k <= 3000; ++k) {
    const double time = 1e-3 * k;
    const PlanarPose p{200 * std::cos(time), 100 + 200 * std::sin(time), -0.3 + 0.2 * time};
    const auto inputs = m4_inputs(g, p);
    if (!inputs) {
      closure = HUGE_VAL;
      break;
    }
    const double c = std::cos(p.phi_rad), s = std::sin(p.phi_rad), l = g.triangle_mm / 2;
    const double h1 = p.x_mm - l * c + g.rails_mm / 2, h2 = p.x_mm + l * c - g.rails_mm / 2;
    closure = std::max({closure, std::abs(std::hypot(h1, p.y_mm - l * s - (*inputs)[0]) - g.rod_mm),
                        std::abs(std::hypot(h2, p.y_mm + l * s - (*inputs)[1]) - g.rod_mm)});
    if (k % 20 == 0) {
      double nearest = HUGE_VAL;
      for (const M4Assembly& a : m4_assemblies(g, *inputs))
        if (a.physical()) nearest = std::min(nearest, std::hypot(a.pose.x_mm - p.x_mm, a.pose.y_mm - p.y_mm));
      back = std::max(back, nearest);
    }
    // d(y1, y2, y3) / d(x, y, phi): where its determinant changes sign the inputs no longer control the tool.
    const double s1 = -h1 / std::sqrt(g.rod_mm * g.rod_mm - h1 * h1),
                 s2 = -h2 / std::sqrt(g.rod_mm * g.rod_mm - h2 * h2);
    const double f1 = -l * (c - s1 * s), f2 = l * (c - s2 * s), f3 = -std::sqrt(3.0) * l * s;
    const double determinant = s1 * (f3 - f2) - s2 * (f3 - f1);
    if (k > 0 && determinant * previous < 0) crossing = time;
    previous = determinant;
  }
  t.below("path of table 4: both rods close", 1e-6, closure, "mm");
  t.below("its poses found again by elimination", 1e-6, back, "mm");
  char words[160];
  std::snprintf(words, sizeof words,
                "not in the paper: its path crosses the mechanism's singular curve at t = %.3f s (x = %.1f "
                "mm, phi = %.2f deg)",
                crossing, 200 * std::cos(crossing), (-0.3 + 0.2 * crossing) / kRadPerDeg);
  t.note(words);
}

}  // namespace

int m4(const std::string& folder) {
  Table t(
      "M4, hybrid mill: forward kinematics (table 6) for 932.6, 1029.4, 283.4 mm, and the path of table 4");
  table6(t);
  table4(t);
  write_picture(folder, "m4-assemblies.svg", draw_m4_assemblies());
  return t.wrong();
}

}  // namespace kinebus::papers
