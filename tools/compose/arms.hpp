#pragma once
// Arms of a body: what stands out from it, with the line that it grows along. The line's direction is where
// sections are smallest; `medial_axis.hpp`, which judges the result, looks at centres of sections instead.

#include <optional>
#include <vector>

#include "tools/compose/overhang.hpp"
#include "tools/compose/section.hpp"

namespace kinebus::compose {

struct ArmPoint {
  Vector at{0, 0, 0};     ///< middle of the section, part coordinates
  Vector along{0, 0, 1};  ///< its normal: from the root to the tip
  double area_mm2 = 0;    ///< of the section
  double extent_mm = 0;   ///< of the section
};

struct Arm {
  std::vector<ArmPoint> line;  ///< from the root to the tip
  bool from_base = false;      ///< it grows from the solid's base, not out of a body
  double width_mm() const;     ///< side of a square like its middle section
  double length_mm() const;
  /// Where a plane meets the line; beyond its ends the line goes straight on.
  Vector where(const Plane& plane) const;
};

/// The arm around a point of the solid. nullopt: it is none, being shorter than wide, a plate, or held at
/// both ends.
std::optional<Arm> arm_around(const Solid& solid, const Sections& sections, const Vector& inside);

/// A stretch of an arm that is printed along one direction.
struct Stretch {
  std::size_t first = 0;  ///< of the arm's points
  Vector normal{0, 0, 1};
};

/// Cuts an arm's line so that it bends away from each stretch's layers' normal by `bend_rad` at most, where
/// directions may lean `max_tilt_rad` at most; beyond, they lean as far as they may. Bends shorter than the
/// arm is wide are no stretch. The first stretch of an arm from the base keeps the base's direction.
std::vector<Stretch> stretches(const Arm& arm, const Vector& base_normal, double bend_rad,
                               double max_tilt_rad);

/// `along`, or the direction next to it that leans `max_tilt_rad` from z.
Vector tilted_at_most(const Vector& along, double max_tilt_rad);

}  // namespace kinebus::compose
