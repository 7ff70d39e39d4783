#include "tools/compose/decompose.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "tools/compose/arm_cut.hpp"
#include "tools/compose/cuts.hpp"

namespace kinebus::compose {
namespace {

constexpr double kRad = std::numbers::pi / 180;
constexpr std::size_t kCutsTried = 60;
/// How much of a cut's own area counts like area that hangs.
constexpr double kSectionWeight = 0.6;
constexpr double kSliversMm2 = 20;

/// What is left at the root of an arm is printed along with it, where that leaves not much more hanging.
constexpr double kLikeArm = 5;  ///< percent of what hangs

struct Candidate {
  Plane plane;
  /// What hangs or is held by nothing: of the piece cut off, and left on the rest.
  double piece_mm2 = 0, rest_mm2 = 0;
  double section_mm2 = 0;  ///< of the cut
  double tilt_rad = 0;
  bool like_arm = false;  ///< as an arm that was taken off before
};

Vector direction(double tilt_rad, double azimuth_rad) {
  return {std::sin(tilt_rad) * std::cos(azimuth_rad), std::sin(tilt_rad) * std::sin(azimuth_rad),
          std::cos(tilt_rad)};
}

/// A grid of directions, and for each hanging face the ones that lean just far enough its way.
std::vector<Vector> directions(const Overhang& overhang, const std::vector<bool>& hanging,
                               const std::vector<Vector>& arms, const DecomposeOptions& options) {
  std::vector<Vector> out = arms;
  const auto add = [&](const Vector& n) {
    const bool known =
        std::any_of(out.begin(), out.end(), [&](const Vector& o) { return o.dot(n) > 0.99996; });
    if (!known) out.push_back(n);
  };
  std::vector<std::size_t> faces;
  for (std::size_t i = 0; i < hanging.size(); ++i)
    if (hanging[i]) faces.push_back(i);
  std::sort(faces.begin(), faces.end(),
            [&](std::size_t a, std::size_t b) { return overhang.areas()[a] > overhang.areas()[b]; });
  for (std::size_t i = 0; i < std::min<std::size_t>(faces.size(), 16); ++i) {
    const Vector& m = overhang.normals()[faces[i]];
    if (std::hypot(m[0], m[1]) < 1e-3) continue;
    const double lean = std::asin(std::clamp(-m[2], -1.0, 1.0));
    const double azimuth = std::atan2(m[1], m[0]);
    for (const double more : {2 * kRad, 10 * kRad, 25 * kRad}) {
      const double tilt = lean - options.max_overhang_rad + more;
      if (tilt > 0 && tilt <= options.max_tilt_rad) add(direction(tilt, azimuth));
    }
  }
  for (const double share : {1.0, 0.85, 0.7, 0.5, 0.3})
    for (int i = 0; i < 24; ++i) add(direction(share * options.max_tilt_rad, i * 15 * kRad));
  return out;
}

std::vector<Candidate> candidates(const Solid& solid, const std::vector<Vector>& arms,
                                  const DecomposeOptions& options) {
  const Overhang overhang(solid.mesh, options.max_overhang_rad);
  const std::vector<bool> hanging = overhang.hanging(solid.base.normal, &solid.base);
  const auto unheld =
      LayeredBody(solid.mesh, solid.base.normal, solid.base.height, options.max_overhang_rad).unheld();
  const double now = overhang.area_mm2(hanging);
  const double now_all = now + LayeredBody::cell_mm2() * static_cast<double>(unheld.size());
  std::vector<Candidate> out;
  for (const Vector& n : directions(overhang, hanging, arms, options)) {
    const bool like_arm = std::find(arms.begin(), arms.end(), n) != arms.end();
    const std::vector<bool> along = overhang.hanging(n, nullptr);
    const UnheldAbove above(solid.mesh, n, options.max_overhang_rad);
    std::vector<double> left;  // heights along n of what nothing holds now
    left.reserve(unheld.size());
    for (const LayeredBody::Place& place : unheld) left.push_back(n.dot(place.at));
    std::sort(left.begin(), left.end());
    for (const double height : heights(solid.mesh, hanging, n)) {
      Candidate candidate{{n, height}, 0, 0, 0, std::acos(std::clamp(n[2], -1.0, 1.0)), like_arm};
      const auto below = std::lower_bound(left.begin(), left.end(), height) - left.begin();
      candidate.rest_mm2 = now - overhang.area_over(hanging, candidate.plane) +
                           LayeredBody::cell_mm2() * static_cast<double>(below);
      candidate.section_mm2 = above.section_mm2(height);
      candidate.piece_mm2 = overhang.area_over(along, candidate.plane) + above.mm2(height);
      if (candidate.rest_mm2 + candidate.piece_mm2 < 0.97 * now_all - 0.5) out.push_back(candidate);
    }
  }
  // First the cuts whose piece prints as it is: what is left on the rest, later cuts can take. Of those the
  // one that leaves least; of about equals the one that tilts less, then the smaller piece.
  const double unit = std::max(0.5, 0.01 * now_all);
  const auto rank = [&](const Candidate& c) {
    return std::round((c.rest_mm2 + kSectionWeight * c.section_mm2) / unit) - (c.like_arm ? kLikeArm : 0) +
           (c.piece_mm2 <= kCleanMm2 ? 0 : 1e6 + std::round(c.piece_mm2 / unit));
  };
  std::sort(out.begin(), out.end(), [&](const Candidate& a, const Candidate& b) {
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    if (std::abs(a.tilt_rad - b.tilt_rad) > 0.5 * kRad) return a.tilt_rad < b.tilt_rad;
    return a.plane.height > b.plane.height;
  });
  return out;
}

std::optional<Parts> best_cut(const Solid& solid, const std::vector<Vector>& arms,
                              const DecomposeOptions& options) {
  const std::vector<Candidate> list = candidates(solid, arms, options);
  std::optional<Parts> otherwise;
  for (std::size_t i = 0; i < std::min(list.size(), kCutsTried); ++i) {
    auto parts = take_off(solid, list[i].plane);
    if (!parts || !has_room(parts->piece, options)) continue;
    // A rest that hangs so little that only slivers could come off is no good end.
    const double hangs_mm2 = std::max(overhang_mm2(parts->rest, options.max_overhang_rad),
                                      unheld_mm2(parts->rest, options.max_overhang_rad));
    if (hangs_mm2 <= options.allowed_mm2 || hangs_mm2 > kSliversMm2) return parts;
    if (!otherwise) otherwise = std::move(parts);
  }
  return otherwise;
}

bool prints_as_it_is(const Solid& solid, const DecomposeOptions& options) {
  return overhang_mm2(solid, options.max_overhang_rad) <= options.allowed_mm2 &&
         unheld_mm2(solid, options.max_overhang_rad) <= options.allowed_mm2;
}

/// `arms`: normals of the arms that were taken off so far.
void decompose_into(const Solid& solid, std::vector<Vector> arms, const DecomposeOptions& options,
                    std::vector<Solid>& out) {
  const bool full = static_cast<int>(out.size()) + 1 >= options.max_pieces;
  if (full || prints_as_it_is(solid, options)) {
    out.push_back(solid);
    return;
  }
  Solid rest = solid;
  const std::vector<Solid> arm = take_arm_off(rest, options);
  if (!arm.empty()) {
    arms.push_back(arm.back().base.normal);
    decompose_into(rest, arms, options, out);
    for (auto piece = arm.rbegin(); piece != arm.rend(); ++piece) decompose_into(*piece, arms, options, out);
    return;
  }
  const auto parts = best_cut(solid, arms, options);
  if (!parts) {
    out.push_back(solid);
    return;
  }
  decompose_into(parts->rest, arms, options, out);
  decompose_into(parts->piece, arms, options, out);
}

}  // namespace

std::vector<Solid> decompose(const Solid& part, const DecomposeOptions& options) {
  std::vector<Solid> out;
  decompose_into(part, {}, options, out);
  return out;
}

std::vector<Solid> decompose(const Solid& part, const std::vector<Plane>& planes,
                             const DecomposeOptions& options) {
  std::vector<Solid> pieces;
  Solid rest = part;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const double tilt = std::acos(std::clamp(planes[i].normal[2], -1.0, 1.0));
    if (tilt > options.max_tilt_rad + 1e-9)
      throw std::runtime_error(
          fmt::format("plane {}: its normal leans {:.1f} deg; the machine tilts at most {:.1f}", i + 1,
                      tilt / kRad, options.max_tilt_rad / kRad));
    auto parts = take_off(rest, planes[i]);
    if (!parts)
      throw std::runtime_error(fmt::format(
          "plane {}: it cuts nothing off, or leaves a body that stands on nothing; check normal and height",
          i + 1));
    pieces.push_back(std::move(parts->piece));
    rest = std::move(parts->rest);
  }
  pieces.push_back(std::move(rest));
  std::reverse(pieces.begin(), pieces.end());
  return pieces;
}

}  // namespace kinebus::compose
