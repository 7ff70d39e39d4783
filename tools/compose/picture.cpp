#include "tools/compose/picture.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace kinebus::compose {
namespace {

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

struct Face {
  std::array<std::array<double, 2>, 3> corners{};
  double depth = 0;
  std::array<int, 3> rgb{};
};

struct Scene {
  double longest_edge_mm = 1e300;
  std::vector<Face> faces;
  double left = 1e300, right = -1e300, low = 1e300, high = -1e300;
  std::vector<std::array<double, 2>> middles;  // of each piece

  void add(const DrawnPiece& piece, std::size_t colour, const Vector& shift) {
    const auto base = piece_colour(colour);
    Vector middle(0, 0, 0);
    for (const Vector& p : piece.mesh.points)
      middle += (p + shift) / static_cast<double>(piece.mesh.points.size());
    middles.push_back({kRight.dot(middle), kUp.dot(middle)});
    for (const auto& triangle : piece.mesh.faces) {
      const Vector &a = piece.mesh.points[triangle[0]], &b = piece.mesh.points[triangle[1]],
                   &c = piece.mesh.points[triangle[2]];
      const Vector n = (b - a).cross(c - a).normalized();
      if (n.dot(kToEye) <= 0) continue;
      const double light = 0.42 + 0.58 * std::max(0.0, n.dot(kLight));
      std::array<int, 3> rgb{};
      for (std::size_t i = 0; i < 3; ++i)
        rgb[i] = static_cast<int>(std::lround(255 * std::min(1.0, base[i] * light * 1.15)));
      add_face({a + shift, b + shift, c + shift}, rgb);
    }
  }

  /// Halved until it is small: sorted by their middles, large faces would hide what is before them.
  void add_face(const std::array<Vector, 3>& corners, const std::array<int, 3>& rgb) {
    std::size_t longest = 0;
    const auto edge = [&](std::size_t i) { return (corners[(i + 1) % 3] - corners[i]).norm(); };
    for (const std::size_t i : {1, 2})
      if (edge(i) > edge(longest)) longest = i;
    if (edge(longest) > longest_edge_mm) {
      const Vector middle = (corners[longest] + corners[(longest + 1) % 3]) / 2;
      std::array<Vector, 3> one = corners, other = corners;
      one[(longest + 1) % 3] = middle;
      other[longest] = middle;
      add_face(one, rgb);
      add_face(other, rgb);
      return;
    }
    Face face;
    face.depth = kToEye.dot(corners[0] + corners[1] + corners[2]) / 3;
    face.rgb = rgb;
    for (std::size_t i = 0; i < 3; ++i) {
      face.corners[i] = {kRight.dot(corners[i]), kUp.dot(corners[i])};
      left = std::min(left, face.corners[i][0]), right = std::max(right, face.corners[i][0]);
      low = std::min(low, face.corners[i][1]), high = std::max(high, face.corners[i][1]);
    }
    faces.push_back(face);
  }

  /// Into a frame of the drawing, in pixels.
  std::string draw(double x, double y, double width, double height, double scale) {
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.depth < b.depth; });
    const double cx = x + width / 2 - scale * (left + right) / 2,
                 cy = y + height / 2 + scale * (low + high) / 2;
    std::string out = "<g stroke-width='1.1' stroke-linejoin='round'>\n";
    for (const Face& face : faces) {
      const std::string rgb = fmt::format("#{:02x}{:02x}{:02x}", face.rgb[0], face.rgb[1], face.rgb[2]);
      out += "<path d='";
      for (std::size_t i = 0; i < 3; ++i)
        fmt::format_to(std::back_inserter(out), "{}{:.1f} {:.1f}", i == 0 ? "M" : "L",
                       cx + scale * face.corners[i][0], cy - scale * face.corners[i][1]);
      fmt::format_to(std::back_inserter(out), "Z' fill='{0}' stroke='{0}'/>\n", rgb);
    }
    out += "</g>\n";
    for (std::size_t i = 0; i < middles.size() && middles.size() > 1; ++i)
      out += fmt::format(
          "<text x='{:.0f}' y='{:.0f}' text-anchor='middle' font-size='15' font-weight='bold' fill='#fff' "
          "stroke='#333' stroke-width='3' paint-order='stroke'>{}</text>\n",
          cx + scale * middles[i][0], cy - scale * middles[i][1] + 5, i + 1);
    return out;
  }
  double scale_for(double width, double height) const {
    return std::min(width / std::max(right - left, 1e-6), height / std::max(high - low, 1e-6));
  }
};

}  // namespace

std::array<double, 3> piece_colour(std::size_t piece) {
  return kColours[piece % kColours.size()];
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
  std::string out =
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1200 640' width='1200' height='640' "
      "font-family='DejaVu Sans, Helvetica, Arial, sans-serif'>\n<rect width='1200' height='640' "
      "fill='#ffffff'/>\n";
  out += fmt::format("<text x='40' y='46' font-size='22' font-weight='bold' fill='#222'>{}</text>\n", title);
  out +=
      "<text x='40' y='74' font-size='14' fill='#666'>the part in one piece, and taken apart in the order of "
      "printing; every piece stands on a level face</text>\n";
  out += together.draw(40, 95, 540, 450, scale) + apart.draw(620, 95, 540, 450, scale);
  double x = 40;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto c = piece_colour(i);
    out += fmt::format(
        "<rect x='{:.0f}' y='577' width='14' height='14' rx='3' fill='#{:02x}{:02x}{:02x}'/>\n", x,
        static_cast<int>(255 * c[0]), static_cast<int>(255 * c[1]), static_cast<int>(255 * c[2]));
    out += fmt::format("<text x='{:.0f}' y='589' font-size='14' fill='#222'>{} {}</text>\n", x + 20, i + 1,
                       pieces[i].caption);
    x += 34 + 7.6 * static_cast<double>(pieces[i].caption.size() + 3);
  }
  return out + "</svg>\n";
}

}  // namespace kinebus::compose
