#include "tools/compose/print_picture.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "tools/compose/picture.hpp"
#include "tools/compose/strands.hpp"
#include "tools/drawing/document.hpp"

namespace kinebus::compose {
namespace {

using drawing::Document;
using drawing::Point;

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
  Point at(const Vector& m) const {
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

/// Rounded to what is printed; never "-0.0".
double positive_zero(double deg) {
  return std::round(deg * 10) / 10 + 0.0;
}

std::vector<Point> circle(const Panel& panel, const Moment& now, double radius, double z) {
  std::vector<Point> points;
  for (int k = 0; k <= 96; ++k) {
    const double f = 2 * std::numbers::pi * k / 96;
    points.push_back(panel.at(now.machine({radius * std::cos(f), radius * std::sin(f), z})));
  }
  return points;
}

void draw_table(Document& document, const Panel& panel, const Moment& now, double radius) {
  for (int k = 8; k >= 1; --k)
    document.polygon(circle(panel, now, radius, -kTableThickness_mm * k / 8),
                     {.fill = "#aeb7c0", .stroke = "#aeb7c0"});
  document.polygon(circle(panel, now, radius, 0), {.fill = "#eceff2", .stroke = "#96a1ab", .width = 1.2});
  for (int r = 10; r < radius - 1; r += 10)
    document.polyline(circle(panel, now, r, 0), {.stroke = "#d3d9de", .width = 0.8});
  const Point middle = panel.at(now.machine({0, 0, 0}));
  document.line(middle, panel.at(now.machine({radius, 0, 0})), {.stroke = "#c2554d", .width = 1.6});
  document.line(middle, panel.at(now.machine({0, radius, 0})), {.stroke = "#4f8a5b", .width = 1.6});
}

void draw_nozzle(Document& document, const Panel& panel, const Nozzle& nozzle, const std::string& metal) {
  const double flat = std::abs(kTowardsEye.z());
  const auto ring = [&](double height, const drawing::Style& style) {
    const double r = panel.scale * nozzle.radius_at(height);
    document.ellipse(panel.at({0, 0, height}), r, r * flat, style);
  };
  {
    const auto solid = document.group({.fill = metal});
    for (int quarter = 0; quarter <= 4 * kSolidNozzle_mm; ++quarter) ring(quarter / 4.0, {});
  }
  ring(kSolidNozzle_mm, {.fill = "#a98450"});
  {
    const auto shadow = document.group({.fill = "#8c97a3", .fill_opacity = 0.16});
    for (int half = 2 * kSolidNozzle_mm; half <= 2 * kDrawnNozzle_mm; ++half) ring(half / 2.0, {});
  }
  ring(kDrawnNozzle_mm, {.fill = "none", .stroke = "#8c97a3", .width = 1, .stroke_opacity = 0.7});
}

void draw_strands(Document& document, const Panel& panel, const Moment& now,
                  const std::vector<Strand>& strands, const PrintPictureOptions& options,
                  const std::string& metal) {
  struct Chunk {
    double nearness = 0;  // horizontally: nothing behind the nozzle's plane hides what is before it
    double depth = 0;
    std::array<Point, 2> ends;
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
    const std::string colour = piece_rgb(static_cast<std::size_t>(s.piece), light);
    const int parts = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kChunk_mm)));
    for (int k = 0; k < parts; ++k) {
      const Vector p = from + (to - from) * k / parts, q = from + (to - from) * (k + 1) / parts;
      chunks.push_back({level.dot(p + q), kTowardsEye.dot(p + q), {panel.at(p), panel.at(q)}, colour});
    }
  }
  std::stable_sort(chunks.begin(), chunks.end(), [](const Chunk& a, const Chunk& b) {
    if ((a.nearness > 0) != (b.nearness > 0)) return b.nearness > 0;
    return a.depth < b.depth;
  });
  const auto before =
      std::find_if(chunks.begin(), chunks.end(), [](const Chunk& c) { return c.nearness > 0; });
  const auto draw = [&](auto from, auto to) {
    const auto group = document.group({.width = panel.scale * options.strand_mm, .round = true});
    for (auto c = from; c != to; ++c) document.polyline(c->ends, {.stroke = c->colour});
  };
  draw(chunks.begin(), before);
  draw_nozzle(document, panel, options.nozzle, metal);
  draw(before, chunks.end());
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
  Document document(kWidth, kTop + kPanelHeight + 84);
  document.heading(
      kMargin, title,
      "The nozzle stands still; the table tilts (A) and turns (C) so that every layer lies level. "
      "No support. Rings on the table: 10 mm; its X red, its Y green.");
  constexpr drawing::GradientStop kBrass[] = {
      {0, "#7d5c2e"}, {0.35, "#e9cf9c"}, {0.6, "#c09a5c"}, {1, "#6d4f26"}};
  const std::string metal = document.gradient(kBrass);
  for (std::size_t n = 0; n < panels.size(); ++n) {
    const Panel& panel = panels[n];
    const Moment& now = moments[n];
    const drawing::Box box{panel.x, kTop, panel.width, kPanelHeight};
    document.rectangle(box, {.fill = "#fafbfc", .stroke = "#d8dee4"}, 8);
    {
      const auto inside = document.clipped(box, 8);
      draw_table(document, panel, now, options.table_radius_mm);
      draw_strands(document, panel, now, strands, options, metal);
    }
    document.rectangle({box.x + 2, box.bottom() + 18, 14, 14},
                       {.fill = piece_rgb(static_cast<std::size_t>(now.piece), 1)}, 3);
    document.text({box.x + 24, box.bottom() + 30}, fmt::format("piece {} of {}", now.piece + 1, pieces),
                  {.size = 15, .bold = true});
    document.text({box.x + 24, box.bottom() + 52},
                  fmt::format("layer {} of {}, A = {:.1f}°, C = {:.1f}°", now.layer, now.layers,
                              positive_zero(now.a_deg), positive_zero(now.c_deg)),
                  {.fill = drawing::kMuted});
  }
  return document.svg();
}

}  // namespace kinebus::compose
