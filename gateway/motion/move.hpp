#pragma once
// One programmed move, as the path is built from it. The path parameter s is its length: X Y Z length in mm;
// of a move without tool motion, the length of its dominant axis, scaled to be dynamically like millimetres
// of tool path.

#include <array>
#include <cmath>
#include <cstdint>

#include "gateway/kinematics/kinematics.hpp"

namespace kinebus {

/// A circle, a helix, or (when the programmed radii at start and end differ by rounding) nearly one:
/// X Y Z = centre + s * slope + radius (u cos(w s) + v sin(w s)).
struct ArcShape {
  std::array<double, 3> centre{}, slope{}, u{}, v{};
  double radius_mm = 0;
  double w_rad_per_mm = 0;
};

struct Move {
  Pose from{}, to{};
  Pose u{};      ///< dx/ds at the start (lines: all along)
  Pose u_end{};  ///< dx/ds at the end
  double length = 0;
  double speed = 0;               ///< ds/dt that the feed asks for; infinite: none
  double accel_mm_per_s2 = 0;     ///< tool acceleration for this kind of move
  double tolerance_mm = 0;        ///< how far the path may leave this move in a corner
  double merge_tolerance_mm = 0;  ///< how far a curve through it and its neighbours may leave it; 0: none
  bool exact = false;             ///< G61: no merging
  bool traverse = false;
  bool tool_motion = false;  ///< X Y Z move, and |dx/ds| of X Y Z is 1
  bool arc = false;
  Frame frame = Frame::kPart;
  std::uint32_t line = 0;
  ArcShape shape{};  ///< arcs only
};

inline double dot_xyz(const Pose& a, const Pose& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double norm_xyz(const Pose& a) {
  return std::sqrt(dot_xyz(a, a));
}

}  // namespace kinebus
