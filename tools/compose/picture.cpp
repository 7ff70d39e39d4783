#include "tools/compose/picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "tools/compose/depth_order.hpp"
#include "tools/drawing/chart.hpp"
#include "tools/drawing/faces.hpp"

namespace kinebus::compose {
namespace {

using drawing::Point;

constexpr std::array<std::array<double, 3>, 8> kColours{{{0.36, 0.48, 0.62},
                                                         {0.93, 0.58, 0.20},
                                                         {0.38, 0.65, 0.42},
                                                         {0.80, 0.36, 0.36},
                                                         {0.55, 0.44, 0.72},
                                                         {0.25, 0.65, 0.70},
                                                         {0.80, 0.68, 0.25},
                                                         {0.62, 0.48, 0.40}}};
const Vector kToEye = Vector(-0.55, -0.75, 0.42).normalized();
const Vector kRight = Vector(0, 0, 1).cross(kToEye).normalized();
const Vector kUp = kToEye.cross(kRight);
const Vector kLight = Vector(-0.2, -0.6, 0.9).normalized();

// More facets than these are ordered by their middles: they are small then, and hide little that they should
// not.
constexpr std::size_t kMostCut = 1500;

struct Scene {
  double longest_edge_mm = 1e300;
  std::vector<Facet> facets;
  double left = 1e300, right = -1e300, low = 1e300, high = -1e300;
  std::vector<Point> middles;  // of each piece

  void add(const DrawnPiece& piece, std::size_t colour, const Vector& shift) {
    const auto base = piece_colour(colour);
    Vector middle(0, 0, 0);
    for (const Vector& p : piece.mesh.points)
      middle += (p + shift) / static_cast<double>(piece.mesh.points.size());
    middles.push_back(seen(middle));
    for (const auto& triangle : piece.mesh.faces) {
      const Vector &a = piece.mesh.points[triangle[0]], &b = piece.mesh.points[triangle[1]],
                   &c = piece.mesh.points[triangle[2]];
      const Vector n = (b - a).cross(c - a).normalized();
      if (!(n.dot(kToEye) > 0)) continue;
      const double light = 0.42 + 0.58 * std::max(0.0, n.dot(kLight));
      const double bright = 255 * light * 1.15;
      facets.push_back({{a + shift, b + shift, c + shift},
                        n,
                        drawing::rgb(base[0] * bright, base[1] * bright, base[2] * bright)});
      for (const Vector& corner : facets.back().corners) {
        const Point p = seen(corner);
        left = std::min(left, p.x), right = std::max(right, p.x);
        low = std::min(low, p.y), high = std::max(high, p.y);
      }
    }
  }

  static Point seen(const Vector& p) { return {kRight.dot(p), kUp.dot(p)}; }

  /// Halved until it is small: sorted by their middles, large faces would hide what is before them.
  void halve(const Facet& facet, std::vector<drawing::Face>& to) const {
    const auto& corners = facet.corners;
    std::size_t longest = 0;
    const auto edge = [&](std::size_t i) { return (corners[(i + 1) % 3] - corners[i]).norm(); };
    for (const std::size_t i : {std::size_t{1}, std::size_t{2}})
      if (edge(i) > edge(longest)) longest = i;
    if (edge(longest) > longest_edge_mm) {
      const Vector middle = (corners[longest] + corners[(longest + 1) % 3]) / 2;
      Facet one = facet, other = facet;
      one.corners[(longest + 1) % 3] = middle;
      other.corners[longest] = middle;
      halve(one, to);
      halve(other, to);
      return;
    }
    to.push_back({{seen(corners[0]), seen(corners[1]), seen(corners[2])},
                  kToEye.dot(corners[0] + corners[1] + corners[2]) / 3,
                  facet.colour});
  }

  std::vector<drawing::Face> faces() const {
    std::vector<drawing::Face> all;
    if (facets.size() > kMostCut) {
      for (const Facet& facet : facets) halve(facet, all);
      return all;
    }
    for (const Facet& f : from_behind(facets))
      all.push_back({{seen(f.corners[0]), seen(f.corners[1]), seen(f.corners[2])},
                     static_cast<double>(all.size()),
                     f.colour});
    return all;
  }

  void draw(drawing::Document& document, const drawing::Box& box, double scale) const {
    const auto at = [&](const Point& p) {
      return Point{box.x + box.width / 2 + scale * (p.x - (left + right) / 2),
                   box.y + box.height / 2 - scale * (p.y - (low + high) / 2)};
    };
    std::vector<drawing::Face> placed = faces();
    for (drawing::Face& face : placed)
      for (Point& p : face.corners) p = at(p);
    drawing::draw_faces(document, std::move(placed), 0.8);
    for (std::size_t i = 0; i < middles.size() && middles.size() > 1; ++i) {
      const Point p = at(middles[i]);
      document.text(
          {p.x, p.y + 5}, std::to_string(i + 1),
          {.size = 15, .anchor = drawing::Anchor::kMiddle, .fill = "white", .bold = true, .halo = "#333333"});
    }
  }
  double scale_for(double width, double height) const {
    return std::min(width / std::max(right - left, 1e-6), height / std::max(high - low, 1e-6));
  }
};

}  // namespace

std::array<double, 3> piece_colour(std::size_t piece) {
  return kColours[piece % kColours.size()];
}

std::string piece_rgb(std::size_t piece, double light) {
  const auto c = piece_colour(piece);
  return drawing::rgb(255 * light * c[0], 255 * light * c[1], 255 * light * c[2]);
}

std::string picture(const std::string& title, const std::vector<DrawnPiece>& pieces) {
  Scene together, apart;
  double size = 0;
  for (const DrawnPiece& piece : pieces) {
    const Box box = bounds(piece.mesh);
    size = std::max(size, (box.high - box.low).norm());
  }
  together.longest_edge_mm = apart.longest_edge_mm = size / 24;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    together.add(pieces[i], i, Vector(0, 0, 0));
    apart.add(pieces[i], i, i == 0 ? Vector(0, 0, 0) : Vector(0.42 * size * pieces[i].frame.normal()));
  }
  together.middles.clear();
  const double scale = std::min(together.scale_for(500, 430), apart.scale_for(500, 430));
  drawing::Document document(1200, 640);
  document.heading(40, title,
                   "The part in one piece, and taken apart in the order of printing; every piece stands on a "
                   "level face");
  together.draw(document, {40, 95, 540, 450}, scale);
  apart.draw(document, {620, 95, 540, 450}, scale);
  double x = 40;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::string words = std::to_string(i + 1) + " " + pieces[i].caption;
    document.rectangle({x, 577, 14, 14}, {.fill = piece_rgb(i, 1)}, 3);
    document.text({x + 20, 589}, words, {.size = 14});
    x += 44 + drawing::text_width(words, 14);
  }
  return document.svg();
}

}  // namespace kinebus::compose
