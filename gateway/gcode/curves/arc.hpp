#pragma once
// The circle of a G2 or G3 in its plane (u, v), where counterclockwise is from u to v.

#include <array>
#include <cstdint>
#include <string>

#include "gateway/result.hpp"
#include "gateway/sentence.hpp"

namespace kinebus::gcode {

using Point2 = std::array<double, 2>;

struct ArcGeometry {
  Point2 centre{};
  Point2 end{};  ///< where the circle is left; differs from the programmed end by the tolerance at most
  double sweep_rad = 0;  ///< > 0
};

/// Centre form (I J K). Post-condition: start and end are equally far from the centre. Radii that differ by
/// no more than `tolerance_mm` are made equal: by moving the centre along the chord, or, when the chord is so
/// short that this would move it by more than ten tolerances, by ending on the start's circle. start == end:
/// a full circle. `turns` >= 1.
Result<ArcGeometry, Sentence> arc_by_centre(Point2 start, Point2 end, Point2 centre, bool clockwise,
                                            int turns, double tolerance_mm);

/// Radius form (R): the arc of no more than half a turn, or with a negative radius the other one. A chord
/// longer than the diameter by no more than `tolerance_mm` is taken for half a turn.
Result<ArcGeometry, Sentence> arc_by_radius(Point2 start, Point2 end, double radius_mm, bool clockwise,
                                            int turns, double tolerance_mm);

}  // namespace kinebus::gcode
