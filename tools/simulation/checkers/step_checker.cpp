#include "tools/simulation/checkers/step_checker.hpp"

#include <cmath>

namespace kinebus {

void StepChecker::on_sample(const Sample& sample, unsigned dead_nodes) {
  const auto dead = [&](std::size_t joint) {
    for (std::size_t n = 0; n < machine_.nodes.size(); ++n)
      if (machine_.nodes[n].id == machine_.joints[joint].node_id) return (dead_nodes >> n & 1u) != 0;
    return false;
  };
  const double dt = to_seconds(sample.time - last_);
  last_ = sample.time;
  // Three equidistant samples make two velocities.
  in_a_row_ = dt < 1.5e-3 ? in_a_row_ + 1 : 0;
  if (in_a_row_ >= 3)
    for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
      const double step = std::abs(sample.joints[j] - 2 * before_[0][j] + before_[1][j]) / dt;
      const double ratio = step / (machine_.joints[j].stop_accel_per_s2 * dt);
      if (ratio <= max_ratio_ || dead(j)) continue;
      max_ratio_ = ratio;
      worst_time_s_ = to_seconds(sample.time);
      worst_joint_ = static_cast<int>(j);
    }
  before_[1] = before_[0];
  before_[0] = sample.joints;
}

std::string StepChecker::worst_joint() const {
  return worst_joint_ < 0 ? "" : machine_.joints[static_cast<std::size_t>(worst_joint_)].name;
}

}  // namespace kinebus
