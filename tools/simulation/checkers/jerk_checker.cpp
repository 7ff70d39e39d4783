#include "tools/simulation/checkers/jerk_checker.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {

JerkChecker::JerkChecker(const MachineDescription& machine, const Kinematics& kinematics, Planned planned)
    : machine_(machine),
      kinematics_(kinematics),
      planned_(std::move(planned)),
      limited_(machine.path.tool_jerk_mm_per_s3 > 0) {
  for (std::size_t j = 0; j < machine.joints.size(); ++j)
    limits_[j] = joint_jerk_limit(machine, machine.joints[j]);
}

std::string JerkChecker::worst_joint() const {
  return worst_joint_ < 0 ? "" : machine_.joints[static_cast<std::size_t>(worst_joint_)].name;
}

void JerkChecker::on_sample(const Sample& sample) {
  constexpr PathTime kStep = std::chrono::milliseconds{1};
  if (!limited_ || !sample.planned || sample.rate < 0.9999) return;
  std::array<JointVector, 4> q{};
  for (std::size_t i = 0; i < q.size(); ++i) {
    const auto planned = planned_(sample.tau - static_cast<int>(i) * kStep);
    if (!planned || !kinematics_.inverse(planned->frame, planned->pose, q[i])) return;
  }
  const double per_h3 = 1 / std::pow(to_seconds(kStep), 3);
  for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
    const double ratio = std::abs(q[0][j] - 3 * q[1][j] + 3 * q[2][j] - q[3][j]) * per_h3 / limits_[j];
    if (ratio > max_ratio_) {
      max_ratio_ = ratio;
      worst_joint_ = static_cast<int>(j);
      worst_time_s_ = to_seconds(sample.time);
    }
  }
}

}  // namespace kinebus
