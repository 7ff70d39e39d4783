#pragma once
// The nozzle's shape, and whether it meets what is printed already.

#include <vector>

#include "tools/compose/mesh.hpp"

namespace kinebus::compose {

/// Round about the tool's axis: radius over the tip, mm, as corners of a profile; beyond the last one
/// constant.
struct Nozzle {
  struct Corner {
    double height_mm = 0, radius_mm = 0;
  };
  std::vector<Corner> profile{{0, 0.5}, {3, 4}, {12, 11}, {13, 22}, {45, 22}, {46, 40}};
  double radius_at(double height_mm) const;
  double widest() const;
};

/// Everything that stands on the table at one moment, seen along one tool direction.
class Obstacles {
 public:
  /// `meshes` in part coordinates, and the table: a disc at z = 0. Surfaces are sampled every `grid_mm`; the
  /// table only where it is higher than `lowest_tip_mm` along the tool, like everything.
  Obstacles(const std::vector<const TriangleMesh*>& meshes, double table_radius_mm, const Vector& tool_up,
            double lowest_tip_mm, double grid_mm = 1);

  /// How far the nozzle reaches into something with its tip there (part coordinates), mm; <= 0: it is free.
  double overlap_mm(const Nozzle& nozzle, const Vector& tip) const;
  bool empty() const { return high_.empty(); }

 private:
  void sample(const Vector& a, const Vector& b, const Vector& c, double lowest, double grid_mm);

  Vector across_, along_, up_;
  struct Sample {
    double x = 0, y = 0, z = 0;
  };
  std::vector<Sample> high_;  ///< in tool directions; only what can be met
};

}  // namespace kinebus::compose
