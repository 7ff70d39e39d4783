#include "tools/compose/arm_cut.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/compose/arms.hpp"
#include "tools/compose/cuts.hpp"

namespace kinebus::compose {
namespace {

constexpr std::size_t kArmsTried = 8;
/// An arm's own section is this much larger at most where a plane cuts it and nothing else.
constexpr double kPure = 1.15;
constexpr int kHeightsOfArm = 24;  ///< to either side of the place where an arm's stretch begins
constexpr double kRootReachOfWidth = 1, kBendReachOfWidth = 0.3;

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

}  // namespace

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

}  // namespace kinebus::compose
