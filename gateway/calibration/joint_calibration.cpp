#include "gateway/calibration/joint_calibration.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/calibration/joint_map.hpp"

namespace kinebus {

JointReserve reserve_for(const JointCalibration& calibration, double speed, double accel) {
  if (calibration.linear()) return {speed, accel, 0};
  // A fifth: 0.1 mm of gap at 5000 mm/s^2 is taken up in 20 ms.
  constexpr double kTakeUpShare = 0.2;
  constexpr double kCurvatureShare = 1.0 / 3;
  const JointMap map(calibration);
  JointReserve r;
  r.take_up_per_s2 = calibration.backlash > 0 ? kTakeUpShare * accel : 0;
  const double stretch = 1 + map.largest_slope();
  r.speed_per_s = (speed - std::sqrt(r.take_up_per_s2 * calibration.backlash)) / stretch;
  if (map.largest_curvature() > 0)
    r.speed_per_s = std::min(r.speed_per_s, std::sqrt(kCurvatureShare * accel / map.largest_curvature()));
  // A machine file may hold any numbers; the planner needs some speed to go on with.
  r.speed_per_s = std::max(r.speed_per_s, 0.05 * speed);
  const double bend = map.largest_curvature() * r.speed_per_s * r.speed_per_s;
  r.accel_per_s2 = std::max((accel - r.take_up_per_s2 - bend) / stretch, 0.05 * accel);
  return r;
}

}  // namespace kinebus
