// The snapshot of the machine.

#include <algorithm>

#include "gateway/machine/core.hpp"

namespace kinebus {

bool Gateway::Core::streams_flow() const {
  const bool state = state_ == MachineState::kMoving || state_ == MachineState::kRunning ||
                     state_ == MachineState::kHolding || state_ == MachineState::kHeld;
  return state && !stream_lost_;
}

void Gateway::Core::remember_positions() {
  for (std::size_t i = 0; i < links_.size(); ++i) positions_[i] = group_.stream(i).final_state();
}

/// By the records of the run under way, else where the nodes rest.
JointVector Gateway::Core::joints_now() const {
  const bool moves = runner_->active() && !runner_->suspended();
  if (moves && !runner_->between_runs())
    if (const auto joints = group_.joints_at(rate_.tau(now_))) return *joints;
  JointVector joints{};
  for (std::size_t i = 0; i < axes_.size(); ++i)
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
      const AxisScaling& scaling = axes_[i].axes[axis];
      const AxisState& state = moves ? group_.stream(i).final_state()[axis] : positions_[i][axis];
      if (scaling.joint >= 0)
        joints[static_cast<std::size_t>(scaling.joint)] =
            scaling.to_joint(to_counts(state.position), group_.side(scaling.joint));
    }
  return joints;
}

void Gateway::Core::set_off_course(MachineStatus& status, std::size_t link) const {
  NodeStatus& node = status.nodes[link];
  const auto& counts = links_[link].following_error();
  if (!counts || !node.present) return;
  for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
    const AxisScaling& scaling = axes_[link].axes[axis];
    if (scaling.joint < 0) continue;
    const auto joint = static_cast<std::size_t>(scaling.joint);
    if (!machine_.joints[joint].has_encoder()) continue;
    node.off_course[axis] = status.off_course[joint] = (*counts)[axis] / scaling.slope();
  }
}

MachineStatus Gateway::Core::status() const {
  MachineStatus s;
  s.state = state_;
  s.now = now_;
  // With a stream that went wrong the nodes stand where they say, not where the gateway has sent them.
  s.positions_known = homed_ && !stream_lost_;
  s.doing = bring_up_.busy()     ? bring_up_.doing()
            : runner_->active()  ? runner_->doing()
            : standstill_.busy() ? say("reading where the nodes stand")
                                 : sentence(state_);
  s.joint_count = static_cast<int>(machine_.joints.size());
  s.joints = joints_now();
  if (homed_) {
    s.pose = s.machine_pose = kinematics_->bed_reference();
    static_cast<void>(kinematics_->forward(Frame::kMachine, s.joints, s.machine_pose));
    s.pose = s.machine_pose;
    static_cast<void>(kinematics_->forward(Frame::kPart, s.joints, s.pose));
  }
  s.path_time_s = to_seconds(rate_.tau(now_));
  s.rate = rate_.rate(now_);
  s.feed_override = override_;
  s.job = job_name_;
  s.interrupted = interrupted() && state_ != MachineState::kRunning;
  if (runner_->active() && !job_follows_) {
    s.line = runner_->line(now_);
    s.elapsed_s = to_seconds(now_ - job_started_);
    const double all = job_name_.empty() ? 0 : job_report_.motion_s;
    const double done = runner_->done_s(now_);
    if (all > 0) {
      s.progress = std::clamp(done / all, 0.0, 1.0);
      s.remaining_s = std::max(0.0, all - done) / override_;
    }
  }
  s.work_system = static_cast<std::uint32_t>(live_lines_.work_system() + 1);
  s.work_offset = live_lines_.work_offset();
  s.hotend = thermal_.heater(Heater::kHotend);
  s.bed = thermal_.heater(Heater::kBed);
  s.fan = thermal_.fan();
  s.spindle = thermal_.spindle();
  s.bus_load = load_.last_second();
  s.bus_load_peak = load_.peak_second();
  s.counters = counters_;
  s.counters.bus_slowdowns = hand_.counters().bus_slowdowns + print_.counters().bus_slowdowns;
  s.counters.starvation_holds = hand_.counters().starvation_holds + print_.counters().starvation_holds;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    s.nodes.push_back(links_[i].status(now_, machine_.bus.heartbeat_timeout));
    s.nodes.back().records_sent = group_.stream(i).counters().records;
    set_off_course(s, i);
    s.counters.sdo_aborts += links_[i].sdo().counters().aborts;
    s.counters.sdo_timeouts += links_[i].sdo().counters().timeouts;
  }
  return s;
}

}  // namespace kinebus
