#pragma once
// q(tau) in the form that the segmenter fits: cubic polynomials in time, joined with continuous value and
// slope. A span's error against the exact inverse kinematics of pose(tau) is below JointSampler's stated
// bound.

#include <array>
#include <cstdint>

#include "gateway/kinematics/kinematics.hpp"

namespace kinebus {

struct JointSpan {
  double start_s = 0;  ///< path time since the start of the run
  double duration_s = 0;
  std::array<std::array<double, 4>, kMaxJoints> coefficients{};  ///< [joint][power of (t - start)], mm or rad
  bool last = false;                                             ///< the run ends at rest with this span
  bool eased = false;  ///< the acceleration changes steadily along it: a limit of jerk holds
  std::uint32_t line = 0;

  double position(int joint, double t) const {
    const auto& c = coefficients[static_cast<std::size_t>(joint)];
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
  }
  double velocity(int joint, double t) const {
    const auto& c = coefficients[static_cast<std::size_t>(joint)];
    return c[1] + t * (2 * c[2] + t * 3 * c[3]);
  }
};

}  // namespace kinebus
