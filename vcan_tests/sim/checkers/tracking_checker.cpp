#include "vcan_tests/sim/checkers/tracking_checker.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {

void TrackingChecker::on_sample(const Sample& sample) {
  if (!sample.planned) return;
  ++samples_;
  double square = 0;
  for (const PoseAxis axis : {kX, kY, kZ}) {
    const double d = sample.pose[axis] - (*sample.planned)[axis];
    square += d * d;
  }
  last_tool_um_ = 1000 * std::sqrt(square);
  if (last_tool_um_ > max_tool_um_) {
    max_tool_um_ = last_tool_um_;
    worst_time_s_ = to_seconds(sample.time);
    worst_line_ = sample.line;
  }

  std::size_t node_index = 0;
  for (const NodeDescription& node : machine_.nodes) {
    const PathTime tau = sample.node_tau[node_index++];
    const auto planned = gateway_.planned_pose(tau);
    JointVector q{};
    if (!planned || !kinematics_.inverse(Frame::kPart, *planned, q)) continue;
    for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
      const JointDescription& joint = machine_.joints[j];
      if (joint.node_id != node.id) continue;
      const double counts = std::abs((sample.joints[j] - q[j]) * joint.drive.counts_per_unit());
      max_joint_counts_ = std::max(max_joint_counts_, counts);
    }
  }
}

}  // namespace kinebus
