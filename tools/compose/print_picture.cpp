#include "tools/compose/print_picture.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>

#include "tools/compose/picture.hpp"
#include "tools/compose/strands.hpp"

namespace kinebus::compose {
namespace {

// Machine frame: X to the right and towards the eye, so that both ways of tilting (about X) show the table's
// face.
const Vector kTowardsEye = Vector(0.86, -0.30, 0.50).normalized();
const Vector kEyeRight = Vector(0, 0, 1).cross(kTowardsEye).normalized();
const Vector kEyeUp = kTowardsEye.cross(kEyeRight);
const Vector kLamp = Vector(0.35, -0.75, 0.85).normalized();
constexpr double kPanelHeight = 470, kTop = 108, kMargin = 36, kGap = 20, kWidth = 1200;
constexpr double kChunk_mm = 2.5;  // strands are sorted by depth in pieces of this length
// The nozzle's cone is drawn solid; what is above it as a shadow of itself, for it would hide the tip.
constexpr int kSolidNozzle_mm = 12, kDrawnNozzle_mm = 34;
constexpr int kLayersInside = 3;  // of the open top: there one sees into the piece
constexpr double kTableThickness_mm = 5;

struct Panel {
  double x = 0, width = 0, scale = 1, tip_x = 0, tip_y = 0;
  std::array<double, 2> at(const Vector& m) const {
    return {tip_x + scale * kEyeRight.dot(m), tip_y - scale * kEyeUp.dot(m)};
  }
};

/// Everything up to one moment of the job, seen from the standing nozzle.
struct Moment {
  std::size_t count = 0;  ///< strands laid
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vector tip{0, 0, 0};
  double a_deg = 0, c_deg = 0;
  int piece = 0, layer = 0, layers = 0;

  Vector machine(const Vector& q) const { return turn * (q - tip); }
};

Moment moment_in(const std::vector<Strand>& strands, int piece, double share) {
  Moment m;
  m.piece = piece;
  double whole = 0, laid = 0;
  std::set<int> layers;
  for (const Strand& s : strands)
    if (s.piece == piece) whole += (s.to - s.from).norm(), layers.insert(s.layer);
  for (const Strand& s : strands) {
    if (s.piece > piece || (s.piece == piece && laid >= share * whole)) break;
    if (s.piece == piece) laid += (s.to - s.from).norm();
    ++m.count;
  }
  m.layers = static_cast<int>(layers.size());
  if (m.count == 0) return m;
  const Strand& last = strands[m.count - 1];
  m.turn = (Eigen::AngleAxisd(last.a_rad, Vector::UnitX()) * Eigen::AngleAxisd(last.c_rad, Vector::UnitZ()))
               .toRotationMatrix();
  m.tip = last.to;
  m.a_deg = last.a_rad * 180 / std::numbers::pi;
  m.c_deg = std::remainder(last.c_rad * 180 / std::numbers::pi, 360.0);
  m.layer = last.layer + 1;
  return m;
}

std::string rgb(const std::array<double, 3>& colour, double light) {
  std::array<int, 3> c{};
  for (std::size_t i = 0; i < 3; ++i)
    c[i] = static_cast<int>(std::lround(255 * std::clamp(colour[i] * light, 0.0, 1.0)));
  return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

/// Rounded to what is printed; never "-0.0".
double positive_zero(double deg) {
  return std::round(deg * 10) / 10 + 0.0;
}

void path(std::string& out, const Panel& panel, const Moment& now, double radius, double z, bool closed,
          const char* style) {
  out += "<path d='";
  for (int k = 0; k <= 96; ++k) {
    const double f = 2 * std::numbers::pi * k / 96;
    const auto p = panel.at(now.machine({radius * std::cos(f), radius * std::sin(f), z}));
    fmt::format_to(std::back_inserter(out), "{}{:.1f} {:.1f}", k == 0 ? "M" : "L", p[0], p[1]);
  }
  fmt::format_to(std::back_inserter(out), "{}' {}/>\n", closed ? "Z" : "", style);
}

void draw_table(std::string& out, const Panel& panel, const Moment& now, double radius) {
  for (int k = 8; k >= 1; --k)
    path(out, panel, now, radius, -kTableThickness_mm * k / 8, true, "fill='#aeb7c0' stroke='#aeb7c0'");
  path(out, panel, now, radius, 0, true, "fill='#eceff2' stroke='#96a1ab' stroke-width='1.2'");
  for (int r = 10; r < radius - 1; r += 10)
    path(out, panel, now, r, 0, false, "fill='none' stroke='#d3d9de' stroke-width='0.8'");
  const auto middle = panel.at(now.machine({0, 0, 0})), x = panel.at(now.machine({radius, 0, 0})),
             y = panel.at(now.machine({0, radius, 0}));
  for (const auto& [to, colour] : {std::pair{x, "#c2554d"}, std::pair{y, "#4f8a5b"}})
    out += fmt::format(
        "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='{}' stroke-width='1.6'/>\n", middle[0],
        middle[1], to[0], to[1], colour);
}

void draw_nozzle(std::string& out, const Panel& panel, const Nozzle& nozzle) {
  const double flat = std::abs(kTowardsEye.z());
  const auto ring = [&](double height, const char* style) {
    const auto p = panel.at({0, 0, height});
    const double r = panel.scale * nozzle.radius_at(height);
    out += fmt::format("<ellipse cx='{:.1f}' cy='{:.1f}' rx='{:.2f}' ry='{:.2f}' {}/>\n", p[0], p[1], r,
                       r * flat, style);
  };
  out += "<g fill='url(#metal)'>\n";
  for (int quarter = 0; quarter <= 4 * kSolidNozzle_mm; ++quarter) ring(quarter / 4.0, "");
  out += "</g>\n";
  ring(kSolidNozzle_mm, "fill='#a98450'");
  out += "<g fill='#8c97a3' opacity='0.16'>\n";
  for (int half = 2 * kSolidNozzle_mm; half <= 2 * kDrawnNozzle_mm; ++half) ring(half / 2.0, "");
  out += "</g>\n";
  ring(kDrawnNozzle_mm, "fill='none' stroke='#8c97a3' stroke-width='1' stroke-opacity='0.7'");
}

void draw_strands(std::string& out, const Panel& panel, const Moment& now, const std::vector<Strand>& strands,
                  const PrintPictureOptions& options) {
  struct Chunk {
    double nearness = 0;  // horizontally: nothing behind the nozzle's plane hides what is before it
    double depth = 0;
    std::array<double, 2> a{}, b{};
    std::string colour;
  };
  std::vector<Chunk> chunks;
  const Vector level = Vector(kTowardsEye.x(), kTowardsEye.y(), 0).normalized();
  std::array<int, 64> last_layer{};
  for (std::size_t i = 0; i < now.count; ++i)
    last_layer[static_cast<std::size_t>(strands[i].piece) % last_layer.size()] = strands[i].layer;
  for (std::size_t i = 0; i < now.count; ++i) {
    const Strand& s = strands[i];
    const int top = last_layer[static_cast<std::size_t>(s.piece) % last_layer.size()];
    if (!s.outside && s.layer < top - kLayersInside && s.layer > 0) continue;
    const Vector from = now.machine(s.from), to = now.machine(s.to), along = (to - from).normalized();
    // A strand is round: the light on the side that is turned to the eye.
    const Vector face = (kTowardsEye - kTowardsEye.dot(along) * along).normalized();
    const double light = 0.50 + 0.55 * std::max(0.0, face.dot(kLamp)) + (s.layer % 2 == 0 ? 0.05 : -0.05);
    const std::string colour = rgb(piece_colour(static_cast<std::size_t>(s.piece)), light);
    const int parts = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kChunk_mm)));
    for (int k = 0; k < parts; ++k) {
      const Vector p = from + (to - from) * k / parts, q = from + (to - from) * (k + 1) / parts;
      chunks.push_back({level.dot(p + q), kTowardsEye.dot(p + q), panel.at(p), panel.at(q), colour});
    }
  }
  std::stable_sort(chunks.begin(), chunks.end(), [](const Chunk& a, const Chunk& b) {
    if ((a.nearness > 0) != (b.nearness > 0)) return b.nearness > 0;
    return a.depth < b.depth;
  });
  const std::string group = fmt::format("<g stroke-linecap='round' fill='none' stroke-width='{:.2f}'>\n",
                                        panel.scale * options.strand_mm);
  out += group;
  bool before = false;
  for (const Chunk& c : chunks) {
    if (c.nearness > 0 && !before) {
      before = true;
      out += "</g>\n";
      draw_nozzle(out, panel, options.nozzle);
      out += group;
    }
    fmt::format_to(std::back_inserter(out), "<path d='M{:.1f} {:.1f}L{:.1f} {:.1f}' stroke='{}'/>\n", c.a[0],
                   c.a[1], c.b[0], c.b[1], c.colour);
  }
  out += "</g>\n";
  if (!before) draw_nozzle(out, panel, options.nozzle);
}

/// The same scale in all panels: whatever is printed and the nozzle fit into each.
void fit(std::vector<Panel>& panels, const std::vector<Moment>& moments, const std::vector<Strand>& strands) {
  struct Extent {
    double left = -12, right = 12, low = -12, high = 30;
  };
  std::vector<Extent> extents(panels.size());
  double scale = 1e9;
  for (std::size_t n = 0; n < panels.size(); ++n) {
    Extent& e = extents[n];
    for (std::size_t i = 0; i < moments[n].count; ++i) {
      const Vector m = moments[n].machine(strands[i].to);
      e.left = std::min(e.left, kEyeRight.dot(m)), e.right = std::max(e.right, kEyeRight.dot(m));
      e.low = std::min(e.low, kEyeUp.dot(m)), e.high = std::max(e.high, kEyeUp.dot(m));
    }
    scale = std::min(
        {scale, 0.80 * panels[n].width / (e.right - e.left), 0.80 * kPanelHeight / (e.high - e.low)});
  }
  for (std::size_t n = 0; n < panels.size(); ++n) {
    const Extent& e = extents[n];
    panels[n].scale = scale;
    panels[n].tip_x = panels[n].x + panels[n].width / 2 - scale * (e.left + e.right) / 2;
    panels[n].tip_y = kTop + kPanelHeight / 2 + scale * (e.low + e.high) / 2;
  }
}

}  // namespace

std::string print_picture(const std::string& title, const JoinedJob& job, const MachineDescription& machine,
                          const PrintPictureOptions& options) {
  const std::vector<Strand> strands = strands_of(job, machine);
  const int pieces = static_cast<int>(job.pieces.size()), shown = std::min(pieces, 4);
  std::vector<Moment> moments;
  std::vector<Panel> panels;
  const double width = (kWidth - 2 * kMargin - kGap * (shown - 1)) / std::max(1, shown);
  for (int n = 0; n < shown; ++n) {
    const int piece = shown > 1 ? static_cast<int>(std::lround(1.0 * n * (pieces - 1) / (shown - 1))) : 0;
    moments.push_back(moment_in(strands, piece, options.part_of_piece));
    panels.push_back({.x = kMargin + n * (width + kGap), .width = width});
  }
  fit(panels, moments, strands);
  const double height = kTop + kPanelHeight + 84;
  std::string out = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' "
      "height='{1:.0f}' font-family='DejaVu Sans, Helvetica, Arial, sans-serif'>\n"
      "<defs><linearGradient id='metal' x1='0' x2='1' y1='0' y2='0'><stop offset='0' stop-color='#7d5c2e'/>"
      "<stop offset='0.35' stop-color='#e9cf9c'/><stop offset='0.6' stop-color='#c09a5c'/>"
      "<stop offset='1' stop-color='#6d4f26'/></linearGradient></defs>\n"
      "<rect width='100%' height='100%' fill='white'/>\n"
      "<text x='{2:.0f}' y='46' font-size='24' font-weight='bold' fill='#1d2733'>{3}</text>\n"
      "<text x='{2:.0f}' y='74' font-size='14' fill='#5a6672'>The nozzle stands still; the table tilts (A) "
      "and turns (C) so that every layer lies level. No support. Rings on the table: 10 mm; its X red, its Y "
      "green.</text>\n",
      kWidth, height, kMargin, title);
  for (std::size_t n = 0; n < panels.size(); ++n) {
    const Panel& panel = panels[n];
    const Moment& now = moments[n];
    out += fmt::format(
        "<clipPath id='panel{0}'><rect x='{1:.1f}' y='{2:.1f}' width='{3:.1f}' height='{4:.1f}' "
        "rx='8'/></clipPath>\n<rect x='{1:.1f}' y='{2:.1f}' width='{3:.1f}' height='{4:.1f}' rx='8' "
        "fill='#fafbfc' stroke='#d8dee4'/>\n<g clip-path='url(#panel{0})'>\n",
        n, panel.x, kTop, panel.width, kPanelHeight);
    draw_table(out, panel, now, options.table_radius_mm);
    draw_strands(out, panel, now, strands, options);
    const auto colour = piece_colour(static_cast<std::size_t>(now.piece));
    out += fmt::format(
        "</g>\n<rect x='{:.1f}' y='{:.1f}' width='14' height='14' rx='3' fill='{}'/>\n<text x='{:.1f}' "
        "y='{:.1f}' font-size='15' font-weight='bold' fill='#1d2733'>piece {} of {}</text>\n<text x='{:.1f}' "
        "y='{:.1f}' font-size='13' fill='#5a6672'>layer {} of {}, A = {:.1f}°, C = {:.1f}°</text>\n",
        panel.x + 2, kTop + kPanelHeight + 18, rgb(colour, 1), panel.x + 24, kTop + kPanelHeight + 30,
        now.piece + 1, pieces, panel.x + 24, kTop + kPanelHeight + 52, now.layer, now.layers,
        positive_zero(now.a_deg), positive_zero(now.c_deg));
  }
  return out + "</svg>\n";
}

}  // namespace kinebus::compose
