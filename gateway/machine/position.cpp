#include "gateway/machine/position.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {

void Position::take_run_end() {
  for (std::size_t i = 0; i < rest_.size(); ++i) rest_[i] = group_.stream(i).final_state();
}

void Position::take(const Standstill& found) {
  for (std::size_t i = 0; i < rest_.size(); ++i) rest_[i] = found.node(i).position;
  homed_ = found.positions_known();
  stream_lost_ = false;
  if (!homed_) filament_beside_mm_ = 0;  // the motor counts anew
}

JointVector Position::joints(const Runner& runner, PathTime tau) const {
  const bool moves = runner.active() && !runner.suspended();
  if (moves && !runner.between_runs())
    if (const auto joints = group_.joints_at(tau)) return *joints;
  JointVector joints{};
  for (std::size_t i = 0; i < axes_.size(); ++i)
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
      const AxisScaling& scaling = axes_[i].axes[axis];
      const AxisState& state = moves ? group_.stream(i).final_state()[axis] : rest_[i][axis];
      if (scaling.joint >= 0)
        joints[static_cast<std::size_t>(scaling.joint)] =
            scaling.to_joint(to_counts(state.position), group_.side(scaling.joint));
    }
  return joints;
}

Result<Pose, Refusal> Position::pose(const JointVector& joints) const {
  Pose pose = kinematics_.bed_reference();
  if (const auto found = kinematics_.forward(Frame::kMachine, joints, pose); !found)
    return refused(say("no pose fits the joints' positions: %1", to_string(found.error())));
  return pose;
}

Position::Distance Position::distance_to(const JointVector& wanted, const PlannedPose& place) const {
  // Which joints the filament moves shows where they go when it does.
  JointVector with_filament{};
  Pose pose = place.pose;
  pose[kE] += 1;
  static_cast<void>(kinematics_.inverse(place.frame, pose, with_filament));
  Distance distance;
  for (std::size_t i = 0; i < axes_.size(); ++i)
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
      const AxisScaling& scaling = axes_[i].axes[axis];
      if (scaling.joint < 0) continue;
      const auto joint = static_cast<std::size_t>(scaling.joint);
      const double counts = std::abs(to_counts(rest_[i][axis].position) - scaling.to_counts(wanted[joint]));
      double& worst =
          std::abs(with_filament[joint] - wanted[joint]) > 0.5 ? distance.filament : distance.others;
      worst = std::max(worst, counts);
    }
  return distance;
}

void Position::report(MachineStatus& s, const JointVector& joints, const std::deque<NodeLink>& links) const {
  s.positions_known = homed_ && !stream_lost_;
  s.joint_count = static_cast<int>(machine_.joints.size());
  s.joints = joints;
  if (homed_) {
    s.pose = s.machine_pose = kinematics_.bed_reference();
    static_cast<void>(kinematics_.forward(Frame::kMachine, joints, s.machine_pose));
    s.pose = s.machine_pose;
    static_cast<void>(kinematics_.forward(Frame::kPart, joints, s.pose));
    s.pose[kE] -= filament_beside_mm_;
    s.machine_pose[kE] -= filament_beside_mm_;
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    NodeStatus& node = s.nodes[i];
    const auto& counts = links[i].following_error();
    if (!counts || !node.present) continue;
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
      const AxisScaling& scaling = axes_[i].axes[axis];
      if (scaling.joint < 0) continue;
      const auto joint = static_cast<std::size_t>(scaling.joint);
      if (!machine_.joints[joint].has_encoder()) continue;
      node.off_course[axis] = s.off_course[joint] = (*counts)[axis] / scaling.slope();
    }
  }
  JointVector measured = joints;
  bool by_encoders = false;
  for (std::size_t joint = 0; joint < machine_.joints.size(); ++joint) {
    if (!s.off_course[joint]) continue;
    by_encoders = true;
    measured[joint] -= *s.off_course[joint];
  }
  if (!by_encoders || !homed_) return;
  Pose pose = s.pose;
  if (!kinematics_.forward(Frame::kPart, measured, pose)) return;
  pose[kE] -= filament_beside_mm_;
  s.measured_pose = pose;
}

}  // namespace kinebus
