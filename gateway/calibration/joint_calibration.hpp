#pragma once
// What was measured about one joint: how its true position differs from what its drive train says.
//
//   drive (1 + scale) = q - e(q) + side * backlash / 2,    e = periodic + table
//
// drive: what the motor's counts mean by the drive train alone, q: the true position, both mm or rad. side:
// +1 after motion in positive direction, -1 after the other, in between while the gap is taken up.

#include <vector>

namespace kinebus {

struct JointCalibration {
  double scale = 0;     ///< measured travel / commanded - 1; a correction to apply has the other sign
  double offset = 0;    ///< mm or rad, added to the home switch position
  double backlash = 0;  ///< mm or rad: the whole gap, forth against back
  /// Error that repeats with each turn of a screw or pulley: e = sine sin(2 pi q / pitch) + cosine cos(...).
  double pitch = 0;  ///< mm or rad of the joint; 0: none
  double periodic_sine = 0, periodic_cosine = 0;
  /// What is left, at start, start + step, ...; a natural cubic spline through it, straight on beyond its
  /// ends.
  double table_start = 0, table_step = 0;
  std::vector<double> table{};

  /// Only scale and offset, which cost nothing in the path.
  bool linear() const { return !(pitch > 0) && table.size() < 2 && !(backlash > 0); }
  friend bool operator==(const JointCalibration&, const JointCalibration&) = default;
};

/// What calibration takes from a joint's limits: the planner plans below, so that the motor keeps them.
struct JointReserve {
  double speed_per_s = 0;     ///< limit for q'
  double accel_per_s2 = 0;    ///< limit for q''
  double take_up_per_s2 = 0;  ///< acceleration kept for taking up the backlash
};

/// `speed`, `accel`: the motor's own limits (in joint units). The bound: |drive'| <= (1 + e1) v +
/// sqrt(take_up backlash) and |drive''| <= (1 + e1) a + e2 v^2 + take_up, e1 and e2 the largest slope and
/// curvature of e(q). When the curvature would eat more than a third of the acceleration, the speed is
/// lowered too.
JointReserve reserve_for(const JointCalibration& calibration, double speed, double accel);

}  // namespace kinebus
