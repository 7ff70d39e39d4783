#include "gateway/shaping/shaped_limits.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {
namespace {

/// What rounding and the cubics' own tolerance (10 mm/s^2) may add.
constexpr double kRounding = 1.005;
/// The mean acceleration of shorter phases says nothing: PathShaper takes turns 0.1 us apart as one.
constexpr double kShortest_s = 50e-6;

}  // namespace

std::optional<ShapedLimits::Excess> ShapedLimits::excess(const Phase& phase) const {
  Excess worst{.ratio = kRounding};
  bool found = false;
  const double middle_s = 0.5 * phase.duration_s;
  for (const double t : {0.0, middle_s, phase.duration_s}) {
    JointPoint joints;
    if (!kinematics_->inverse_along(phase.piece.frame, phase.at(t), joints)) continue;
    const bool judges_accel = t == middle_s && phase.duration_s > kShortest_s;
    for (int j = 0; j < kinematics_->joint_count(); ++j) {
      const auto i = static_cast<std::size_t>(j);
      const double speed = std::abs(joints.q1[i]) / speed_[i];
      const double accel = judges_accel ? std::abs(joints.q2[i]) / accel_[i] : 0;
      const double ratio = std::max(speed, accel);
      if (!(ratio > worst.ratio)) continue;
      worst = {j, accel > speed, ratio};
      found = true;
    }
  }
  return found ? std::optional(worst) : std::nullopt;
}

}  // namespace kinebus
