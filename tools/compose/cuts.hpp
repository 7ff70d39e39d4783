#pragma once
// One plane through a solid: what it takes off, and what is left hanging.

#include <algorithm>
#include <optional>
#include <vector>

#include "tools/compose/decompose.hpp"
#include "tools/compose/support.hpp"

namespace kinebus::compose {

inline constexpr double kCleanMm2 = 1;  ///< a piece with less of it prints as it is

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

/// Heights worth a cut: just under the corners of what hangs, mm along `n`.
std::vector<double> heights(const TriangleMesh& mesh, const std::vector<bool>& hanging, const Vector& n);

struct Parts {
  Solid rest, piece;
};

/// What is over the plane, and the rest. None: one of them is next to nothing, or would be printed into the
/// air.
std::optional<Parts> take_off(const Solid& solid, const Plane& plane);

/// The nozzle has room over the tilted table wherever the piece has a corner.
bool has_room(const Solid& piece, const DecomposeOptions& options);

}  // namespace kinebus::compose
