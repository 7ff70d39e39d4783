#pragma once
// Poses and paths that are drawn from one seed, and a machine for them.

#include <cmath>
#include <random>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus::testing {

/// The default M1 upside down, with everything off its centre.
inline M1Geometry hanging() {
  M1Geometry g;
  g.tool = ToolPlacement::kPlatform;
  g.nozzle_mm = {3, -2, -180};
  g.table_mm = {5, -4, 80};
  for (M1Leg& leg : g.legs) {
    leg.foot_mm[2] = 1020;
    leg.attachment_mm[2] = 5;
    leg.connector_mm = -leg.connector_mm;
    leg.carriage_above = true;
  }
  return g;
}

class RandomPose {
 public:
  explicit RandomPose(unsigned seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  /// In the cylinder that the default M1 is made for: radius 100 mm, height 200 mm, |A| <= 45 deg.
  Pose in_m1_cylinder() {
    const double r = 100 * std::sqrt(uniform(0, 1)), f = uniform(-3.2, 3.2);
    return {r * std::cos(f), r * std::sin(f),   uniform(0, 200), uniform(-45, 45) * kRadPerDeg,
            uniform(-7, 7),  uniform(-50, 5000)};
  }

  /// A smooth path through a pose: every axis moves, turns and bends.
  PosePoint path_through(const Pose& x) {
    PosePoint p{.x = x, .x1 = {}, .x2 = {}};
    constexpr double kSpeed[kPoseAxes] = {1, 1, 1, 0.02, 0.05, 0.3};
    for (std::size_t k = 0; k < kPoseAxes; ++k) {
      p.x1[k] = kSpeed[k] * uniform(-1, 1);
      p.x2[k] = 0.1 * kSpeed[k] * uniform(-1, 1);
    }
    return p;
  }

 private:
  std::mt19937_64 engine_;
};

/// x(s) of the parabola with these derivatives at s = 0.
inline Pose at(const PosePoint& p, double s) {
  Pose x{};
  for (std::size_t k = 0; k < kPoseAxes; ++k) x[k] = p.x[k] + s * (p.x1[k] + 0.5 * s * p.x2[k]);
  return x;
}

}  // namespace kinebus::testing
