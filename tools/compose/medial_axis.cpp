#include "tools/compose/medial_axis.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "tools/compose/section.hpp"

namespace kinebus::compose {
namespace {

constexpr int kSections = 25, kRepetitions = 40;
constexpr double kSettled_rad = 1e-4;
/// Sections of an arm, of the median one. Others, where it comes out of a body, are left out.
constexpr double kSmallest = 0.6, kLargest = 1.4;
constexpr double kArmShare = 0.7;   ///< of the sections have to be of that size
constexpr double kPlateExtent = 2;  ///< of a section, of a square's side with its area: more is a plate

struct Line {
  Vector along{0, 0, 1};
  double of_one_size = 0;  ///< share of the sections
};

/// A point of the piece at a height: the middle of its own section.
std::optional<Vector> middle_of(const TriangleMesh& piece, const Plane& plane) {
  Vector sum = Vector::Zero();
  double length = 0;
  for (const auto& face : piece.faces) {
    std::array<Vector, 2> ends{Vector::Zero(), Vector::Zero()};
    std::size_t found = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector &p = piece.points[face[k]], &q = piece.points[face[(k + 1) % 3]];
      const double dp = plane.over(p), dq = plane.over(q);
      if ((dp < 0) != (dq < 0) && found < 2) ends[found++] = p + dp / (dp - dq) * (q - p);
    }
    if (found < 2) continue;
    const double part = (ends[1] - ends[0]).norm();
    length += part;
    sum += part / 2 * (ends[0] + ends[1]);
  }
  if (!(length > 0)) return {};
  return sum / length;
}

std::optional<Line> centre_line(const Sections& part, const TriangleMesh& piece, const Vector& normal) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Vector& p : piece.points) {
    low = std::min(low, normal.dot(p));
    high = std::max(high, normal.dot(p));
  }
  std::vector<std::pair<double, Section>> all;
  for (int k = 0; k < kSections; ++k) {
    const double height = low + (high - low) * (0.25 + 0.5 * (k + 0.5) / kSections);
    const Plane plane{normal, height};
    const auto inside = middle_of(piece, plane);
    if (const auto section = inside ? part.at(plane, *inside) : std::nullopt)
      all.emplace_back(height - low, *section);
  }
  if (all.empty()) return {};
  std::vector<double> areas;
  areas.reserve(all.size());
  for (const auto& [h, section] : all) areas.push_back(section.area_mm2);
  std::nth_element(areas.begin(), areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2), areas.end());
  const double usual_mm2 = areas[areas.size() / 2];
  // Least squares of centre over height; what is left across the normal is the lean.
  double n = 0, sum_h = 0, sum_hh = 0;
  Vector sum = Vector::Zero(), sum_hc = Vector::Zero();
  for (const auto& [h, section] : all) {
    if (section.area_mm2 < kSmallest * usual_mm2 || section.area_mm2 > kLargest * usual_mm2 ||
        section.extent_mm > kPlateExtent * std::sqrt(section.area_mm2))
      continue;
    const Vector c = section.centre - (h + low) * normal;
    n += 1;
    sum_h += h;
    sum_hh += h * h;
    sum += c;
    sum_hc += h * c;
  }
  const double spread = n * sum_hh - sum_h * sum_h;
  if (!(spread > 0)) return {};
  return Line{(normal + (n * sum_hc - sum_h * sum) / spread).normalized(), n / kSections};
}

}  // namespace

MedialAxis medial_axis(const TriangleMesh& part, const TriangleMesh& piece, const Vector& normal) {
  const Sections sections(part);
  MedialAxis out{normal, false};
  for (int i = 0; i < kRepetitions; ++i) {
    const auto line = centre_line(sections, piece, out.along);
    if (!line) return {normal, false};
    const double turned = std::atan2(line->along.cross(out.along).norm(), line->along.dot(out.along));
    out.along = line->along;
    out.of_arm = line->of_one_size >= kArmShare;
    if (turned < kSettled_rad) return out;
  }
  return {out.along, false};
}

}  // namespace kinebus::compose
