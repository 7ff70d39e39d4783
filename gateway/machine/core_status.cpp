// The snapshot of the machine.

#include <algorithm>

#include "gateway/machine/core.hpp"

namespace kinebus {

bool Gateway::Core::may_glance() const {
  return voice_.speaks() && !bring_up_.busy() && !rest_.reading() && !clearing_.busy() &&
         !watch_.needs_bring_up() && state_.now() != MachineState::kOff &&
         state_.now() != MachineState::kHoming;
}

/// Of the job, also while it is interrupted and on its way back; of a move when there is no job.
void Gateway::Core::report_progress(MachineStatus& s) const {
  double done_s = 0, all_s = 0;
  if (const auto& left = recovery_.left()) {
    if (!left->state.time) return;
    s.line = left->state.time->line;
    done_s = left->state.time->done_s;
    all_s = left->state.time->motion_s;
    s.elapsed_s = print_.elapsed_s(now_);
  } else if (const Runner& job = print_.runner(); job.active()) {
    s.line = job.line(now_);
    done_s = job.done_s(now_);
    all_s = print_.report().motion_s;
    s.elapsed_s = print_.elapsed_s(now_);
    if (const auto pose = machine_pose()) s.job_filament_mm = print_.filament_mm((*pose)[kE]);
  } else if (runner_->active() && !hand_.leads_to(ManualMotion::Then::kJob)) {
    s.line = runner_->line(now_);
    s.elapsed_s = to_seconds(now_ - started_);
  }
  if (!(all_s > 0)) return;
  s.progress = std::clamp(done_s / all_s, 0.0, 1.0);
  s.remaining_s = std::max(0.0, all_s - done_s) / override_;
}

MachineStatus Gateway::Core::status() const {
  MachineStatus s;
  s.state = state_.now();
  s.now = now_;
  const bool held_by_heat = s.state == MachineState::kHeld && !heat_hold_.why().empty();
  s.doing = bring_up_.busy()    ? bring_up_.doing()
            : held_by_heat      ? heat_hold_.why()
            : runner_->active() ? runner_->doing()
            : rest_.reading()   ? say("reading where the nodes stand")
                                : sentence(s.state);
  s.path_time_s = to_seconds(rate_.tau(now_));
  s.rate = rate_.rate(now_);
  s.feed_override = override_;
  s.job = print_.name();
  s.interrupted = interrupted() && s.state != MachineState::kRunning;
  s.filament_change = print_.runner().changes_filament();
  report_progress(s);
  report_objects(s);
  s.work_system = static_cast<std::uint32_t>(lines_.work_system());
  s.work_offset = lines_.work_offset();
  heat_.report(s);
  s.bus_load = voice_.load().last_second();
  s.bus_load_peak = voice_.load().peak_second();
  s.counters = counters_;
  for (const Runner* runner : {&hand_.runner(), &print_.runner()}) {
    s.counters.bus_slowdowns += runner->counters().bus_slowdowns;
    s.counters.starvation_holds += runner->counters().starvation_holds;
  }
  for (std::size_t i = 0; i < links_.size(); ++i) {
    s.nodes.push_back(links_[i].status(now_, machine_.bus.heartbeat_timeout));
    if (i < axes_.size()) s.nodes.back().records_sent = group_.stream(i).counters().records;
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
      s.nodes.back().current_a[axis] = currents_.amperes(i, axis, now_);
      s.nodes.back().by_scale_mm[axis] = scales_.joint_mm(i, axis);
      s.nodes.back().stage_celsius[axis] = currents_.celsius(i, axis, now_);
      s.nodes.back().position_counts[axis] = links_[i].position_counts(axis);
    }
    s.counters.sdo_aborts += links_[i].sdo().counters().aborts;
    s.counters.sdo_timeouts += links_[i].sdo().counters().timeouts;
  }
  for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
    const JointDescription& joint = machine_.joints[j];
    const std::size_t axis = joint.axis & 1u;
    for (NodeStatus& node : s.nodes) {
      if (node.id != joint.node_id) continue;
      node.run_current_a[axis] = joint.run_current_ma * 1e-3;
      node.hold_current_a[axis] = joint.hold_current_ma * 1e-3;
      node.measures[axis] = motors_.tuned() == j;
    }
  }
  position_.report(s, joints_now(), links_);
  return s;
}

}  // namespace kinebus
