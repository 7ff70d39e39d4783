#include "tools/simulation/checkers/joint_checker.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/bytes.hpp"

namespace kinebus {
namespace {
constexpr std::uint32_t kSegmentCobId = 0x400;
constexpr double kRaw = 4294967296.0;
}  // namespace

JointChecker::JointChecker(const MachineDescription& machine) : machine_(machine) {
  for (std::size_t j = 0; j < machine.joints.size(); ++j) {
    const JointDescription& joint = machine.joints[j];
    const double counts = std::abs(joint.drive.counts_per_unit());
    AxisLimits& limits = nodes_[joint.node_id].limits[joint.axis];
    limits.joint = static_cast<int>(j);
    limits.velocity = joint.speed_per_s * counts * kSecondsPerUnit * kRaw;
    limits.acceleration = joint.accel_per_s2 * counts * kSecondsPerUnit * kSecondsPerUnit * kRaw /
                          std::exp2(kDefaultAccelerationShift + 1);
  }
}

void JointChecker::on_frame(const CanFrame& frame) {
  if (frame.extended || frame.length != 8 || frame.id <= kSegmentCobId || frame.id >= kSegmentCobId + 128)
    return;
  const auto segment = decode_segment(get_u64_le(frame.data));
  if (!segment || segment->duration == 0) return;
  ++segments_;
  NodeTrack& node = nodes_[frame.id - kSegmentCobId];
  for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
    const AxisLimits& limits = node.limits[axis];
    if (limits.joint < 0) continue;
    AxisState& state = node.state[axis];
    state = advance(state, segment->acceleration[axis], segment->duration, kDefaultAccelerationShift);
    max_velocity_ = std::max(max_velocity_, std::abs(static_cast<double>(state.velocity)) / limits.velocity);
    max_acceleration_ =
        std::max(max_acceleration_, std::abs(segment->acceleration[axis]) / limits.acceleration);
  }
}

void JointChecker::on_sample(const Sample& sample) {
  const double dt = to_seconds(sample.time - last_);
  last_ = sample.time;
  // Differences only across equidistant samples at full rate: a stop has limits of its own.
  in_a_row_ = sample.in_job && sample.rate > 0.9999 && dt < 1.5e-3 ? in_a_row_ + 1 : 0;
  if (in_a_row_ >= 3)
    for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
      const double second = sample.joints[j] - 2 * history_[0][j] + history_[1][j];
      max_measured_ = std::max(max_measured_, std::abs(second) / (dt * dt) / machine_.joints[j].accel_per_s2);
      max_velocity_ = std::max(
          max_velocity_, std::abs(sample.joints[j] - history_[0][j]) / dt / machine_.joints[j].speed_per_s);
    }
  history_[1] = history_[0];
  history_[0] = sample.joints;
}

}  // namespace kinebus
