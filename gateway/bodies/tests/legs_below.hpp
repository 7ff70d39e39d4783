#pragma once
// A machine of M1's kind whose legs and carriages are below the platform, with bodies: it can be built, and
// everything above its table is free.

#include "gateway/description/machine_description.hpp"

namespace kinebus {

/// Reaches a cylinder of 200 mm diameter and height over the table at every tilt up to 45 deg.
inline MachineDescription legs_below() {
  MachineDescription d = default_m1();
  d.name = "legs below";
  auto& g = std::get<M1Geometry>(d.kinematics);
  constexpr double kFeet[4][2] = {{273, 63}, {273, -63}, {-273, -252}, {-273, 252}};
  constexpr double kAttachments[4][2] = {{124, 128}, {124, -128}, {-124, -69}, {-124, 69}};
  for (std::size_t i = 0; i < 4; ++i)
    g.legs[i] = {.foot_mm = {kFeet[i][0], kFeet[i][1], 0},
                 .attachment_mm = {kAttachments[i][0], kAttachments[i][1], -5},
                 .length_mm = 991,
                 .carriage_above = false,
                 .travel_mm = {0, 520}};
  g.nozzle_mm = {0, 0, 1300};
  g.limits.z_mm = {-5, 200};
  g.limits.radius_mm = 100;
  g.max_leg_angle_rad = 30 * kRadPerDeg;
  g.max_condition = 8;
  for (std::size_t i = 0; i < 4; ++i) {
    d.joints[i].travel = {0, 520};
    d.joints[i].homing->method = 21;
    d.joints[i].homing->switch_position = 0;
    d.joints[i].homing->max_search = 600;
  }
  d.bodies.emplace();
  return d;
}

}  // namespace kinebus
