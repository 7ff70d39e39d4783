#include "tools/simulation/checkers/tracking_checker.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {

void TrackingChecker::on_sample(const Sample& sample) {
  if (!sample.planned) return;
  ++samples_;
  check_tool(sample);
  check_joints(sample);
}

/// In part coordinates, so that an error of the table's rotations counts where the tip is.
void TrackingChecker::check_tool(const Sample& sample) {
  Pose planned = sample.planned->pose;
  // Both frames are the same where the table has not turned.
  if (sample.planned->frame != Frame::kPart && (planned[kA] != 0 || planned[kC] != 0)) {
    JointVector q{};
    if (!kinematics_.inverse(sample.planned->frame, planned, q)) return;
    planned = sample.pose;
    if (!kinematics_.forward(Frame::kPart, q, planned)) return;
  }
  double square = 0;
  for (const PoseAxis axis : {kX, kY, kZ}) {
    const double d = sample.pose[axis] - planned[axis];
    square += d * d;
  }
  last_tool_um_ = 1000 * std::sqrt(square);
  tool_squares_um2_ += last_tool_um_ * last_tool_um_;
  ++tools_;
  if (last_tool_um_ > max_tool_um_) {
    max_tool_um_ = last_tool_um_;
    worst_time_s_ = to_seconds(sample.time);
    worst_line_ = sample.line;
  }
}

void TrackingChecker::check_joints(const Sample& sample) {
  for (std::size_t n = 0; n < static_cast<std::size_t>(sample.node_count); ++n) {
    const auto planned = planned_(sample.node_tau[n]);
    JointVector q{};
    if (!planned || !kinematics_.inverse(planned->frame, planned->pose, q)) continue;
    for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
      const JointDescription& joint = machine_.joints[j];
      if (joint.node_id != machine_.nodes[n].id) continue;
      const double counts = std::abs((sample.joints[j] - q[j]) * joint.drive.counts_per_unit());
      if (counts > max_joint_counts_) {
        max_joint_counts_ = counts;
        worst_joint_ = static_cast<int>(j);
        worst_joint_time_s_ = to_seconds(sample.time);
      }
    }
  }
}

}  // namespace kinebus
