#include "tools/workspace/picture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tools/workspace/boundary.hpp"

namespace kinebus::workspace {
namespace {

constexpr double kWidth = 1280, kHeight = 800;
constexpr const char* kInk = "#1d2733";
constexpr const char* kFaint = "#c9d1d9";

template <typename... Values>
void print(std::string& out, const char* format, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  out += text;
}

void label(std::string& out, double x, double y, const char* words, int size = 13,
           const char* anchor = "middle", const char* more = "") {
  print(out, "<text x='%.1f' y='%.1f' font-size='%d' text-anchor='%s' fill='%s' %s>%s</text>\n", x, y, size,
        anchor, kInk, more, words);
}

void line(std::string& out, double x0, double y0, double x1, double y1, const char* colour, double width) {
  print(out, "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='%s' stroke-width='%.1f'/>\n", x0, y0, x1,
        y1, colour, width);
}

/// Looks at the body from the front right, from above.
struct View {
  double azimuth, elevation, scale, centre_x, centre_y, middle_z;
  struct Seen {
    double x, y, depth;
  };
  Seen operator()(double x, double y, double z) const {
    const double ca = std::cos(azimuth), sa = std::sin(azimuth), ce = std::cos(elevation),
                 se = std::sin(elevation);
    const double across = -sa * x + ca * y, away = ca * x + sa * y, up = z - middle_z;
    return {centre_x + scale * across, centre_y - scale * (ce * up - se * away), ce * away + se * up};
  }
};

void body(std::string& out, const Scan& s, const View& view) {
  // The cut opens towards the eye.
  const double towards = view.azimuth;
  const auto triangles = boundary(s, -1, {towards - 0.95, towards + 0.65});
  struct Face {
    double depth;
    std::array<View::Seen, 3> corner;
    std::array<int, 3> colour;
  };
  std::vector<Face> faces;
  constexpr double kLight[3] = {0.45, 0.35, 0.82};
  for (const Triangle& t : triangles) {
    Face f{};
    double u[3], v[3];
    for (std::size_t k = 0; k < 3; ++k) {
      f.corner[k] = view(t.corner[k][0], t.corner[k][1], t.corner[k][2]);
      f.depth += f.corner[k].depth / 3;
      u[k] = t.corner[1][k] - t.corner[0][k];
      v[k] = t.corner[2][k] - t.corner[0][k];
    }
    const double area = (f.corner[1].x - f.corner[0].x) * (f.corner[2].y - f.corner[0].y) -
                        (f.corner[1].y - f.corner[0].y) * (f.corner[2].x - f.corner[0].x);
    if (area > 0) continue;  // turned away
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::hypot(n[0], n[1], n[2]);
    const double light = length > 0 ? (n[0] * kLight[0] + n[1] * kLight[1] + n[2] * kLight[2]) / length : 0;
    const double shade = 0.72 + 0.28 * std::max(0.0, light);
    f.colour = colour(t.shade);
    for (int& c : f.colour) c = static_cast<int>(std::lround(c * shade));
    faces.push_back(f);
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.depth < b.depth; });
  out += "<g stroke-width='0.6' stroke-linejoin='round'>\n";
  for (const Face& f : faces)
    print(out, "<path d='M%.1f %.1fL%.1f %.1fL%.1f %.1fz' fill='#%02x%02x%02x' stroke='#%02x%02x%02x'/>\n",
          f.corner[0].x, f.corner[0].y, f.corner[1].x, f.corner[1].y, f.corner[2].x, f.corner[2].y,
          f.colour[0], f.colour[1], f.colour[2], f.colour[0], f.colour[1], f.colour[2]);
  out += "</g>\n";
}

void ring(std::string& out, const View& view, double radius, double z, const char* colour, double width) {
  out += "<path fill='none' d='";
  for (int k = 0; k <= 96; ++k) {
    const double a = 2 * std::numbers::pi * k / 96;
    const View::Seen p = view(radius * std::cos(a), radius * std::sin(a), z);
    print(out, "%s%.1f %.1f", k == 0 ? "M" : "L", p.x, p.y);
  }
  print(out, "' stroke='%s' stroke-width='%.1f'/>\n", colour, width);
}

void axes(std::string& out, const View& view, const Scan& s) {
  const double r = s.room.radius_mm * 1.12, floor = s.room.z_min_mm;
  ring(out, view, s.room.radius_mm, floor, kFaint, 1.2);
  const auto arrow = [&](double x, double y, double z, const char* name) {
    const View::Seen a = view(0, 0, floor), b = view(x, y, floor + z);
    line(out, a.x, a.y, b.x, b.y, kFaint, 1.2);
    label(out, b.x + (b.x > a.x ? 12 : -12), b.y + 5, name, 15);
  };
  arrow(r * 1.1, 0, 0, "X");
  arrow(0, r * 1.1, 0, "Y");
}

struct Panel {
  double x, y, w, h;
};

/// Section through the axis: the share of tilts that each place allows.
void section(std::string& out, const Scan& s, const Panel& p) {
  label(out, p.x + p.w / 2, p.y - 26, "Section in the XZ plane: share of tilts allowed", 15);
  const double scale = std::min(p.w / (2 * s.room.radius_mm), p.h / (s.room.z_max_mm - s.room.z_min_mm));
  const double cx = p.x + p.w / 2, bottom = p.y + p.h;
  out += "<g shape-rendering='crispEdges'>\n";
  for (int plane = 0; plane < s.planes; ++plane)
    for (const int ray : {0, s.rays / 2})
      for (int radius = 0; radius < s.radii;) {
        // Runs of one colour are one rectangle.
        const auto share = [&](int k) { return std::popcount(s.allowed[s.cell(plane, ray, k)]); };
        int to = radius + 1;
        while (to < s.radii && share(to) == share(radius)) ++to;
        if (share(radius) > 0) {
          const auto c = colour(static_cast<double>(share(radius)) / s.tilts);
          const double r0 = radius * s.options.step_mm, r1 = to * s.options.step_mm;
          const double x0 = ray == 0 ? r0 : -r1;
          print(out, "<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='#%02x%02x%02x'/>\n",
                cx + scale * x0, bottom - scale * (s.z_mm(plane) + s.options.step_mm / 2 - s.room.z_min_mm),
                scale * (r1 - r0), scale * s.options.step_mm + 0.3, c[0], c[1], c[2]);
        }
        radius = to;
      }
  out += "</g>\n";
  const auto outline = [&](const Cylinder& c, const char* dash, const char* words) {
    if (!(c.radius_mm > 0)) return;
    const double top = bottom - scale * (c.z_max_mm - s.room.z_min_mm);
    print(out,
          "<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='none' stroke='white' stroke-width='2' "
          "%s/>\n",
          cx - scale * c.radius_mm, top, 2 * scale * c.radius_mm, scale * (c.z_max_mm - c.z_min_mm), dash);
    label(out, cx, top + 18, words, 12, "middle", "style='fill:#1d2733'");
  };
  char words[128];
  const Cylinder always = largest_cylinder(s, -1);
  std::snprintf(words, sizeof words, "every tilt: %.0f x %.0f mm", 2 * always.radius_mm,
                always.z_max_mm - always.z_min_mm);
  outline(always, "", words);
  const double left = cx - scale * s.room.radius_mm, right = cx + scale * s.room.radius_mm;
  line(out, left, bottom, right, bottom, kInk, 1);
  for (int x = -150; x <= 150; x += 50)
    if (std::abs(x) <= s.room.radius_mm) {
      std::snprintf(words, sizeof words, "%d", x);
      line(out, cx + scale * x, bottom, cx + scale * x, bottom + 5, kInk, 1);
      label(out, cx + scale * x, bottom + 19, words, 12);
    }
  for (int z = 0; z <= s.room.z_max_mm; z += 50) {
    const double y = bottom - scale * (z - s.room.z_min_mm);
    std::snprintf(words, sizeof words, "%d", z);
    line(out, left - 5, y, left, y, kInk, 1);
    label(out, left - 9, y + 4, words, 12, "end");
  }
  label(out, cx, bottom + 37, "X, mm", 13);
  label(out, left - 42, bottom - scale * (s.room.z_max_mm - s.room.z_min_mm) / 2, "Z, mm", 13);
}

/// Volume against tilt: all that is reached, and the cylinder in it.
void curves(std::string& out, const Scan& s, const Panel& p) {
  label(out, p.x + p.w / 2, p.y - 14, "Volume at each tilt", 15);
  double most = 0;
  std::vector<double> reached, inscribed;
  for (int tilt = 0; tilt < s.tilts; ++tilt) {
    reached.push_back(volume_mm3(s, tilt) * 1e-6);
    inscribed.push_back(largest_cylinder(s, tilt).volume_mm3() * 1e-6);
    most = std::max(most, reached.back());
  }
  const double top = std::max(1.0, std::ceil(most / 2) * 2);
  const auto x_of = [&](double tilt) {
    const double range = s.room.tilt_max_rad - s.room.tilt_min_rad;
    return range > 0 ? p.x + p.w * (tilt - s.room.tilt_min_rad) / range : p.x + p.w / 2;
  };
  char words[64];
  for (double v = 0; v <= top + 1e-9; v += top / 4) {
    const double y = p.y + p.h - p.h * v / top;
    line(out, p.x, y, p.x + p.w, y, v > 0 ? "#e4e8ec" : kInk, 1);
    std::snprintf(words, sizeof words, "%g", v);
    label(out, p.x - 8, y + 4, words, 12, "end");
  }
  for (int deg = -90; deg <= 90; deg += 15) {
    const double tilt = deg * kRadPerDeg;
    if (tilt < s.room.tilt_min_rad - 1e-9 || tilt > s.room.tilt_max_rad + 1e-9) continue;
    std::snprintf(words, sizeof words, "%d", deg);
    label(out, x_of(tilt), p.y + p.h + 18, words, 12);
  }
  label(out, p.x + p.w / 2, p.y + p.h + 36, "tilt A, deg", 13);
  label(out, p.x - 44, p.y + p.h / 2, "litres", 13);
  const auto curve = [&](const std::vector<double>& v, const char* stroke) {
    out += "<path fill='none' stroke-linejoin='round' d='";
    for (int k = 0; k < s.tilts; ++k)
      print(out, "%s%.1f %.1f", k == 0 ? "M" : "L", x_of(s.tilt_rad(k)),
            p.y + p.h - p.h * v[static_cast<std::size_t>(k)] / top);
    print(out, "' stroke='%s' stroke-width='2.5'/>\n", stroke);
  };
  curve(reached, "#29788e");
  curve(inscribed, "#e07b39");
  // Below both curves, which start well above the axis.
  label(out, p.x + 10, p.y + p.h - 28, "reached", 13, "start", "style='fill:#29788e'");
  label(out, p.x + 10, p.y + p.h - 10, "largest upright cylinder in it", 13, "start", "style='fill:#e07b39'");
}

void colour_bar(std::string& out, double x, double y, int tilts) {
  for (int k = 0; k < 100; ++k) {
    const auto c = colour(k / 99.0);
    print(out, "<rect x='%.1f' y='%.1f' width='2.6' height='12' fill='#%02x%02x%02x'/>\n", x + 2.4 * k, y,
          c[0], c[1], c[2]);
  }
  char words[64];
  std::snprintf(words, sizeof words, "all %d tilts", tilts);
  label(out, x, y + 28, "one tilt", 12, "start");
  label(out, x + 242, y + 28, words, 12, "end");
}

}  // namespace

std::string draw_workspace(const Scan& fine, const Scan& coarse, const PictureText& text) {
  std::string out;
  print(out,
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %.0f %.0f' width='%.0f' height='%.0f' "
        "font-family='DejaVu Sans, Helvetica, Arial, sans-serif'>\n<rect width='100%%' height='100%%' "
        "fill='white'/>\n",
        kWidth, kHeight, kWidth, kHeight);
  label(out, 40, 46, text.title.c_str(), 24, "start", "font-weight='bold'");
  label(out, 40, 72, text.subtitle.c_str(), 14, "start", "style='fill:#5a6672'");
  const Room& room = coarse.room;
  const double size = std::max(2 * room.radius_mm * 1.15, (room.z_max_mm - room.z_min_mm) * 1.3);
  const View view{
      -35 * kRadPerDeg, 28 * kRadPerDeg, 560 / size, 355, 440, (room.z_min_mm + room.z_max_mm) / 2};
  axes(out, view, coarse);
  body(out, coarse, view);
  const Cylinder always = largest_cylinder(fine, -1);
  if (always.radius_mm > 0) {
    ring(out, view, always.radius_mm, always.z_min_mm, "white", 1.4);
    ring(out, view, always.radius_mm, always.z_max_mm, "white", 1.4);
  }
  colour_bar(out, 235, 745, fine.tilts);
  section(out, fine, {810, 150, 420, 270});
  curves(out, fine, {810, 530, 420, 190});
  out += "</svg>\n";
  return out;
}

}  // namespace kinebus::workspace
