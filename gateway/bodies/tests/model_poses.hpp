#pragma once
// What tests of collision models ask of one: a distance by kinds of bodies, and poses to ask it at.

#include <algorithm>
#include <cmath>
#include <random>

#include "gateway/bodies/collision_model.hpp"

namespace kinebus::bodies {

/// Distance of two kinds of bodies, all of their numbers apart.
inline double modelled(const CollisionModel& model, const Scene& scene, BodyId a, BodyId b) {
  double least = HUGE_VAL;
  for (const CollisionModel::Pair& pair : model.pairs()) {
    const BodyId first = model.bodies()[pair.first].id, second = model.bodies()[pair.second].id;
    if ((first == a && second == b) || (first == b && second == a))
      least = std::min(least, model.distance(scene, pair));
  }
  return least;
}

inline Pose random_pose(std::mt19937& source, double radius_mm, double z_mm, double tilt_rad) {
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(source);
  };
  const double r = radius_mm * std::sqrt(in(0, 1)), angle = in(-3.14, 3.14);
  return {r * std::cos(angle), r * std::sin(angle), in(0, z_mm), in(-tilt_rad, tilt_rad), in(-3, 3), 0};
}

}  // namespace kinebus::bodies
