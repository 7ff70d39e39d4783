#include "tools/workspace/picture.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tools/drawing/chart.hpp"
#include "tools/drawing/colour.hpp"
#include "tools/drawing/faces.hpp"
#include "tools/workspace/boundary.hpp"

namespace kinebus::workspace {
namespace {

using drawing::Anchor;
using drawing::Document;

std::string words(const char* format, auto... values) {
  char text[128];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// Looks at the body from the front right, from above.
struct View {
  double azimuth, elevation, scale, centre_x, centre_y, middle_z;
  struct Seen {
    drawing::Point at;
    double depth;
  };
  Seen operator()(double x, double y, double z) const {
    const double ca = std::cos(azimuth), sa = std::sin(azimuth), ce = std::cos(elevation),
                 se = std::sin(elevation);
    const double across = -sa * x + ca * y, away = ca * x + sa * y, up = z - middle_z;
    return {{centre_x + scale * across, centre_y - scale * (ce * up - se * away)}, ce * away + se * up};
  }
};

void body(Document& document, const Scan& s, const View& view) {
  // The cut opens towards the eye.
  const double towards = view.azimuth;
  std::vector<drawing::Face> faces;
  constexpr double kLight[3] = {0.45, 0.35, 0.82};
  for (const Triangle& t : boundary(s, -1, {towards - 0.95, towards + 0.65})) {
    drawing::Face f;
    double u[3], v[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const View::Seen seen = view(t.corner[k][0], t.corner[k][1], t.corner[k][2]);
      f.corners[k] = seen.at;
      f.depth += seen.depth / 3;
      u[k] = t.corner[1][k] - t.corner[0][k];
      v[k] = t.corner[2][k] - t.corner[0][k];
    }
    const auto& c = f.corners;
    const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
    if (area > 0) continue;  // turned away
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::hypot(n[0], n[1], n[2]);
    const double light = length > 0 ? (n[0] * kLight[0] + n[1] * kLight[1] + n[2] * kLight[2]) / length : 0;
    const double shade = 0.72 + 0.28 * std::max(0.0, light);
    const auto colour = drawing::scale_colour(t.shade);
    f.colour = drawing::rgb(colour[0] * shade, colour[1] * shade, colour[2] * shade);
    faces.push_back(std::move(f));
  }
  drawing::draw_faces(document, std::move(faces), 0.6);
}

void ring(Document& document, const View& view, double radius, double z, const drawing::Style& style) {
  std::vector<drawing::Point> points;
  for (int k = 0; k <= 96; ++k) {
    const double a = 2 * std::numbers::pi * k / 96;
    points.push_back(view(radius * std::cos(a), radius * std::sin(a), z).at);
  }
  document.polyline(points, style);
}

void axes(Document& document, const View& view, const Scan& s) {
  const drawing::Style faint{.stroke = drawing::kFaint, .width = 1.2};
  const double r = s.room.radius_mm * 1.12 * 1.1, floor = s.room.z_min_mm;
  ring(document, view, s.room.radius_mm, floor, faint);
  const auto arrow = [&](double x, double y, const char* name) {
    const drawing::Point a = view(0, 0, floor).at, b = view(x, y, floor).at;
    document.line(a, b, faint);
    document.text({b.x + (b.x > a.x ? 12 : -12), b.y + 5}, name, {.size = 15, .anchor = Anchor::kMiddle});
  };
  arrow(r, 0, "X");
  arrow(0, r, "Y");
}

/// Section through the axis: the share of tilts that each place allows.
void section(Document& document, const Scan& s, const drawing::Box& room, const Cylinder& always) {
  const double radius = s.room.radius_mm, span = s.room.z_max_mm - s.room.z_min_mm;
  const double scale = std::min(room.width / (2 * radius), room.height / span);
  const drawing::Chart chart{.area = {room.x + room.width / 2 - scale * radius, room.bottom() - scale * span,
                                      2 * scale * radius, scale * span},
                             .x_low = -radius,
                             .x_high = radius,
                             .y_low = s.room.z_min_mm,
                             .y_high = s.room.z_max_mm};
  {
    const auto group = document.group({.crisp = true});
    for (int plane = 0; plane < s.planes; ++plane)
      for (const int ray : {0, s.rays / 2})
        for (int from = 0; from < s.radii;) {
          // Runs of one colour are one rectangle.
          const auto share = [&](int k) { return std::popcount(s.allowed[s.cell(plane, ray, k)]); };
          int to = from + 1;
          while (to < s.radii && share(to) == share(from)) ++to;
          if (share(from) > 0) {
            const double r0 = from * s.options.step_mm, r1 = to * s.options.step_mm;
            const drawing::Point corner =
                chart.at(ray == 0 ? r0 : -r1, s.z_mm(plane) + s.options.step_mm / 2);
            document.rectangle({corner.x, corner.y, scale * (r1 - r0), scale * s.options.step_mm + 0.3},
                               {.fill = drawing::scale_rgb(static_cast<double>(share(from)) / s.tilts)});
          }
          from = to;
        }
  }
  if (always.radius_mm > 0) {
    const drawing::Point corner = chart.at(-always.radius_mm, always.z_max_mm);
    document.rectangle(
        {corner.x, corner.y, 2 * scale * always.radius_mm, scale * (always.z_max_mm - always.z_min_mm)},
        {.fill = "none", .stroke = "#1d2733", .width = 2});
    document.text(
        {chart.at(0, 0).x, corner.y + 18},
        words("every tilt: %.0f x %.0f mm", 2 * always.radius_mm, always.z_max_mm - always.z_min_mm),
        {.size = 12, .anchor = Anchor::kMiddle});
  }
  drawing::draw_frame(document, chart,
                      {.x_step = 50,
                       .y_step = 50,
                       .title = "Section in the XZ plane: share of tilts allowed",
                       .x_name = "X, mm",
                       .y_name = "Z, mm",
                       .grid = false});
}

/// Volume against tilt: all that is reached, and the cylinder in it.
void curves(Document& document, const Scan& s, const drawing::Box& area) {
  double most = 0;
  std::vector<drawing::Point> reached, inscribed;
  for (int tilt = 0; tilt < s.tilts; ++tilt) {
    const double a_deg = s.tilt_rad(tilt) / kRadPerDeg;
    reached.push_back({a_deg, volume_mm3(s, tilt) * 1e-6});
    inscribed.push_back({a_deg, largest_cylinder(s, tilt).volume_mm3() * 1e-6});
    most = std::max(most, reached.back().y);
  }
  const double top = std::max(1.0, std::ceil(most / 2) * 2);
  drawing::Chart chart{.area = area,
                       .x_low = s.room.tilt_min_rad / kRadPerDeg,
                       .x_high = s.room.tilt_max_rad / kRadPerDeg,
                       .y_high = top};
  // A scan of one tilt: it stands in the middle.
  if (!(chart.x_high > chart.x_low)) chart.x_low -= 1, chart.x_high += 1;
  drawing::draw_frame(document, chart,
                      {.x_step = 15,
                       .y_step = top / 4,
                       .title = "Volume at each tilt",
                       .x_name = "tilt A, deg",
                       .y_name = "litres"});
  constexpr const char *kReached = "#29788e", *kInscribed = "#e07b39";
  drawing::draw_curve(document, chart, reached, kReached, 2.5);
  drawing::draw_curve(document, chart, inscribed, kInscribed, 2.5);
  // Below both curves, which start well above the axis.
  document.text({area.x + 10, area.bottom() - 28}, "reached", {.fill = kReached});
  document.text({area.x + 10, area.bottom() - 10}, "largest upright cylinder in it", {.fill = kInscribed});
}

}  // namespace

std::string draw_workspace(const Scan& fine, const Scan& coarse, const PictureText& text) {
  Document document(1280, 800);
  document.heading(40, text.title, text.subtitle);
  const Room& room = coarse.room;
  const double size = std::max(2 * room.radius_mm * 1.15, (room.z_max_mm - room.z_min_mm) * 1.3);
  const View view{
      -35 * kRadPerDeg, 28 * kRadPerDeg, 560 / size, 355, 440, (room.z_min_mm + room.z_max_mm) / 2};
  axes(document, view, coarse);
  body(document, coarse, view);
  const Cylinder always =
      standing_cylinder(fine, text.table_radius_mm > 0 ? text.table_radius_mm : fine.room.radius_mm);
  if (always.radius_mm > 0)
    for (const double z : {always.z_min_mm, always.z_max_mm})
      ring(document, view, always.radius_mm, z, {.stroke = "#1d2733", .width = 1.4});
  const drawing::Box bar{235, 745, 242, 12};
  drawing::colour_bar(document, bar);
  document.text({bar.x, bar.bottom() + 16}, "one tilt", {.size = 12});
  document.text({bar.right(), bar.bottom() + 16}, words("all %d tilts", fine.tilts),
                {.size = 12, .anchor = Anchor::kEnd});
  section(document, fine, {810, 150, 420, 270}, always);
  curves(document, fine, {810, 530, 420, 190});
  return document.svg();
}

}  // namespace kinebus::workspace
