#pragma once
// Geometry for a wanted print volume: a search over rails, attachments and leg length of M1's mechanism.

#include <string>

#include "tools/workspace/scan.hpp"

namespace kinebus::workspace {

/// How well a geometry serves a room: over a grid of its poses.
struct Fitness {
  double reached = 0;          ///< share of the poses that the legs reach within leg angle and conditioning
  double worst_condition = 0;  ///< over the reached poses
  double worst_leg_angle_rad = 0;
  Interval travel_mm{};     ///< that the carriages use, all legs together
  double footprint_mm = 0;  ///< radius of the circle around the rails
  double cost = 0;          ///< what the search makes small
};

Fitness fitness(const M1Geometry& geometry, const Room& room);

struct Optimised {
  M1Geometry
      geometry;  ///< travel limits as the room needs them, with 10 mm to spare, and the room as its limits
  Fitness before, after;
  int tried = 0;
};

/// From `start`: rails keep their directions, legs their order and sides.
Optimised optimise(const M1Geometry& start, const Room& room);

/// The [kinematics] tables of a machine file.
std::string geometry_toml(const M1Geometry& geometry);

}  // namespace kinebus::workspace
