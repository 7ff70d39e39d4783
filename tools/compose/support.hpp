#pragma once
// What would be printed into the air: a body looked at layer by layer along a direction. Finds what faces
// alone do not tell: strands that begin beside the body and hang from nothing until they meet it.

#include <vector>

#include "tools/compose/overhang.hpp"

namespace kinebus::compose {

/// Resolution: cells of 0.5 mm in layers of 2 mm; a cell is held by cells of the layer below within the reach
/// of the overhang limit and one cell more.
class LayeredBody {
 public:
  /// Layers along `up`, the first from `from_mm` (height along `up`).
  LayeredBody(const TriangleMesh& mesh, const Vector& up, double from_mm, double limit_rad);

  struct Place {
    double height_mm = 0;  ///< along `up`: middle of the layer
    Vector at{0, 0, 0};    ///< part coordinates
  };
  /// Cells that nothing holds. The first layer is held where the body touches the plane at `from_mm`.
  std::vector<Place> unheld() const;
  static double cell_mm2();
  /// Area of the body's section at a height, mm^2, to the resolution of the layers.
  double section_mm2(double height_mm) const;

 private:
  using Bitmap = std::vector<bool>;
  Bitmap slice(double height_mm) const;
  double layer_height(int layer) const;
  int layers() const;
  bool held(const Bitmap& below, int x, int y) const;

  TriangleMesh mesh_;  // in the frame across, along, up
  Vector across_, along_, up_;
  double from_, top_ = 0, left_ = 0, front_ = 0;
  int columns_ = 0, rows_ = 0;
  double reach_mm_;
  mutable std::vector<double> sections_mm2_;  // of each layer, once asked for
};

/// Area that nothing holds when the body is printed on its base, mm^2 (summed over the layers).
double unheld_mm2(const Solid& solid, double limit_rad);

}  // namespace kinebus::compose
