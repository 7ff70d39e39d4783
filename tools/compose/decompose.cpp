#include "tools/compose/decompose.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "tools/compose/arms.hpp"
#include "tools/compose/mesh_kernel.hpp"
#include "tools/compose/support.hpp"

namespace kinebus::compose {
namespace {

constexpr double kRad = std::numbers::pi / 180;
/// A plane is laid this far under the corner that it is to cut at: no sliver is left hanging.
constexpr double kUnderCornerMm = 0.02;
constexpr double kSmallestPieceMm3 = 10;
constexpr double kCleanMm2 = 1;  ///< a piece with less of it prints as it is
constexpr std::size_t kHeightsPerDirection = 40;
constexpr std::size_t kCutsTried = 60;
/// How much of a cut's own area counts like area that hangs.
constexpr double kSectionWeight = 0.6;
constexpr double kSliversMm2 = 20;
constexpr std::size_t kArmsTried = 8;
/// An arm's own section is this much larger at most where a plane cuts it and nothing else.
constexpr double kPure = 1.15;
constexpr int kHeightsOfArm = 24;  ///< to either side of the place where an arm's stretch begins
constexpr double kRootReachOfWidth = 1, kBendReachOfWidth = 0.3;

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

/// What nothing holds along a direction, for any height at which a cut begins: sums from the top down.
class UnheldAbove {
 public:
  UnheldAbove(const TriangleMesh& mesh, const Vector& n, double limit_rad)
      : body_(mesh, n, lowest(mesh, n), limit_rad) {
    for (const LayeredBody::Place& place : body_.unheld()) heights_.push_back(place.height_mm);
    std::sort(heights_.begin(), heights_.end());
  }
  double mm2(double height) const {
    const auto from = std::lower_bound(heights_.begin(), heights_.end(), height);
    return LayeredBody::cell_mm2() * static_cast<double>(heights_.end() - from);
  }
  double section_mm2(double height) const { return body_.section_mm2(height); }

 private:
  static double lowest(const TriangleMesh& mesh, const Vector& n) {
    double out = 1e300;
    for (const Vector& p : mesh.points) out = std::min(out, n.dot(p));
    return out;
  }
  LayeredBody body_;
  std::vector<double> heights_;
};

/// Heights worth a cut: just under the corners of what hangs.
std::vector<double> heights(const TriangleMesh& mesh, const std::vector<bool>& hanging, const Vector& n) {
  std::vector<double> all;
  for (std::size_t i = 0; i < hanging.size(); ++i)
    if (hanging[i])
      for (const std::uint32_t corner : mesh.faces[i]) all.push_back(n.dot(mesh.points[corner]));
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end(), [](double a, double b) { return b - a < 0.01; }), all.end());
  std::vector<double> out;
  const std::size_t step = all.size() / kHeightsPerDirection + 1;
  for (std::size_t i = 0; i < all.size(); i += step) out.push_back(all[i] - kUnderCornerMm);
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

/// Every body of the mesh reaches down to the base: nothing would be printed into the air.
bool stands(const TriangleMesh& mesh, const Plane& base) {
  for (const TriangleMesh& body : bodies(mesh)) {
    double lowest = 1e300;
    for (const Vector& p : body.points) lowest = std::min(lowest, base.over(p));
    if (lowest > 0.05) return false;
  }
  return true;
}

struct Parts {
  Solid rest, piece;
};

std::optional<Parts> take_off(const Solid& solid, const Plane& plane) {
  Halves halves = cut(solid.mesh, plane);
  if (volume_mm3(halves.above) < kSmallestPieceMm3 || volume_mm3(halves.below) < kSmallestPieceMm3) return {};
  if (!stands(halves.above, plane) || !stands(halves.below, solid.base)) return {};
  return Parts{{std::move(halves.below), solid.base}, {std::move(halves.above), plane}};
}

/// The nozzle has room over the tilted table wherever the piece has a corner.
bool has_room(const Solid& piece, const DecomposeOptions& options) {
  const Obstacles table({}, options.table_radius_mm, piece.base.normal, piece.base.height);
  return table.empty() ||
         std::all_of(piece.mesh.points.begin(), piece.mesh.points.end(), [&](const Vector& p) {
           return table.overlap_mm(options.nozzle, p + 0.1 * piece.base.normal) <= -1;
         });
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

/// What hangs on the part of a solid that a cut leaves.
class LeftBelow {
 public:
  LeftBelow(const Solid& solid, const DecomposeOptions& options)
      : overhang_(solid.mesh, options.max_overhang_rad),
        hanging_(overhang_.hanging(solid.base.normal, &solid.base)),
        now_mm2_(overhang_.area_mm2(hanging_)),
        unheld_(LayeredBody(solid.mesh, solid.base.normal, solid.base.height, options.max_overhang_rad)
                    .unheld()) {}
  double mm2(const Plane& plane) const {
    const auto below = std::count_if(unheld_.begin(), unheld_.end(),
                                     [&](const LayeredBody::Place& p) { return plane.over(p.at) < 0; });
    return now_mm2_ - overhang_.area_over(hanging_, plane) +
           LayeredBody::cell_mm2() * static_cast<double>(below);
  }
  const Overhang& overhang() const { return overhang_; }
  const std::vector<bool>& hanging() const { return hanging_; }

 private:
  Overhang overhang_;
  std::vector<bool> hanging_;
  double now_mm2_;
  std::vector<LayeredBody::Place> unheld_;
};

/// Heights along `n` near `middle`, and those just under corners of what hangs.
std::vector<double> heights_near(const TriangleMesh& mesh, const LeftBelow& left, const Vector& n,
                                 double middle, double reach_mm) {
  std::vector<double> out;
  for (int k = -kHeightsOfArm; k <= kHeightsOfArm; ++k) out.push_back(middle + reach_mm * k / kHeightsOfArm);
  for (const double height : heights(mesh, left.hanging(), n))
    if (std::abs(height - middle) < reach_mm) out.push_back(height);
  std::sort(out.begin(), out.end());
  return out;
}

/// Takes off what an arm has from one stretch on, where the cut leaves least hanging: across the arm alone.
std::optional<Parts> arm_cut(const Solid& solid, const Arm& arm, const Stretch& stretch, std::size_t end,
                             const DecomposeOptions& options) {
  const LeftBelow left(solid, options);
  const Sections sections(solid.mesh);
  const Vector& n = stretch.normal;
  const ArmPoint& usual = arm.line[(stretch.first + end) / 2];
  const double cosine = std::max(0.1, n.dot(usual.along));
  const auto pure = [&](double height) {
    const Plane plane{n, height};
    const auto section = sections.at(plane, arm.where(plane));
    return section && section->parts == 1 && section->area_mm2 * cosine <= kPure * usual.area_mm2;
  };
  const double middle = n.dot(arm.line[stretch.first].at);
  const double reach_mm = (stretch.first == 0 ? kRootReachOfWidth : kBendReachOfWidth) * arm.width_mm();
  std::vector<double> tried = heights_near(solid.mesh, left, n, middle, reach_mm);
  // Where the arm just comes out of the body.
  for (std::size_t i = 1, count = tried.size(); i < count; ++i) {
    double low = tried[i - 1], high = tried[i];
    if (pure(low) || !pure(high)) continue;
    while (high - low > 0.005) (pure((low + high) / 2) ? high : low) = (low + high) / 2;
    tried.push_back(high);
  }
  constexpr double kFar_mm2_per_mm = 0.05;  // of equals the nearest
  std::optional<Plane> best;
  double best_mm2 = 0;
  for (const double height : tried) {
    const double mm2 = left.mm2({n, height}) + kFar_mm2_per_mm * std::abs(height - middle);
    if ((best && mm2 >= best_mm2) || !pure(height)) continue;
    best = Plane{n, height}, best_mm2 = mm2;
  }
  if (!best) return {};
  const double hangs_on_piece = left.overhang().area_over(left.overhang().hanging(n, nullptr), *best) +
                                UnheldAbove(solid.mesh, n, options.max_overhang_rad).mm2(best->height);
  const double taken_mm2 = left.mm2({n, HUGE_VAL}) - left.mm2(*best);
  if (hangs_on_piece > std::max(kCleanMm2, taken_mm2 / 2)) return {};
  auto parts = take_off(solid, *best);
  return parts && has_room(parts->piece, options) ? std::move(parts) : std::nullopt;
}

/// The middle of the wall behind a face.
Vector behind(const TriangleMesh& mesh, const Overhang& overhang, std::size_t face) {
  const auto corner = [&](std::size_t f, std::size_t k) -> const Vector& {
    return mesh.points[mesh.faces[f][k]];
  };
  const Vector from = (corner(face, 0) + corner(face, 1) + corner(face, 2)) / 3;
  const Vector inward = -overhang.normals()[face];
  double depth = HUGE_VAL;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Vector& m = overhang.normals()[f];
    const double slope = m.dot(inward);
    if (slope <= 1e-9) continue;
    const double t = m.dot(corner(f, 0) - from) / slope;
    if (t <= 1e-6 || t >= depth) continue;
    const Vector hit = from + t * inward;
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k)
      inside = inside && (corner(f, (k + 1) % 3) - corner(f, k)).cross(hit - corner(f, k)).dot(m) >= -1e-9;
    if (inside) depth = t;
  }
  return from + (std::isfinite(depth) ? depth / 2 : 0) * inward;
}

/// Takes the stretches of one arm that hangs off the solid, the tip's first. Empty: there is none that comes
/// off.
std::vector<Solid> take_arm_off(Solid& solid, const DecomposeOptions& options) {
  const Overhang overhang(solid.mesh, options.max_overhang_rad);
  const std::vector<bool> hanging = overhang.hanging(solid.base.normal, &solid.base);
  std::vector<std::size_t> faces;
  for (std::size_t i = 0; i < hanging.size(); ++i)
    if (hanging[i]) faces.push_back(i);
  std::stable_sort(faces.begin(), faces.end(),
                   [&](std::size_t a, std::size_t b) { return overhang.areas()[a] > overhang.areas()[b]; });
  const Sections sections(solid.mesh);
  for (std::size_t i = 0; i < std::min(faces.size(), kArmsTried); ++i) {
    const auto arm = arm_around(solid, sections, behind(solid.mesh, overhang, faces[i]));
    if (!arm) continue;
    std::vector<Solid> pieces;
    Solid rest = solid;
    for (const double share : {1.0, 0.85, 0.7, 0.5}) {  // less where the nozzle has no room over the table
      const auto along =
          stretches(*arm, solid.base.normal, options.max_bend_rad, share * options.max_tilt_rad);
      std::size_t end = arm->line.size() - 1;
      for (std::size_t k = along.size(); k-- > (arm->from_base ? 1U : 0U);) {
        auto parts = arm_cut(rest, *arm, along[k], end, options);
        if (!parts) continue;
        pieces.push_back(std::move(parts->piece));
        rest = std::move(parts->rest);
        end = along[k].first;
      }
      if (pieces.empty()) continue;
      solid = std::move(rest);
      return pieces;
    }
  }
  return {};
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
