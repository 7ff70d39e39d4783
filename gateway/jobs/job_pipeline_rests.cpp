// What begins at rest and leads to a place that the text does not name: G28, and a probe's move.

#include <utility>

#include "gateway/jobs/job_pipeline.hpp"
#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {
namespace {
constexpr std::size_t kMostTouched = std::size_t{canonical::Mesh::kMostPoints} * canonical::Mesh::kMostPoints;
}  // namespace

/// The path begins anew, at rest, with the modes and limits in force.
void JobPipeline::start_at(const Pose& pose, Frame frame, std::uint32_t line) {
  shaper_.reset();
  planner_.reset(pose, frame);
  if (path_mode_) static_cast<void>(planner_.add({line, *path_mode_}));
  static_cast<void>(planner_.add({line, limits_}));
}

/// G28 while positions are known: the machine goes where homing would leave it.
void JobPipeline::home(const canonical::Home& home, std::uint32_t line) {
  const Frame frame = home.frame;
  if (planner_.end_frame() != frame) {
    const auto pose = convert_pose(kinematics_, planner_.end_frame(), planner_.end_pose(), frame);
    if (!pose) return refuse(line_of(line), 0, say("G28: %1", to_string(pose.error())));
    first_.push_back({line, canonical::SetPosition{*pose, home.frame}});
  }
  Pose target = home.afterwards;
  target[kE] = planner_.end_pose()[kE];
  first_.push_back({line, canonical::Traverse{target, home.frame}});
  first_.push_back({line, canonical::WaitIdle{}});
}

/// A run of its own. An override above 100 % does not make it faster.
void JobPipeline::plan_probe() {
  const auto start = convert_pose(kinematics_, planner_.end_frame(), planner_.end_pose(), probe_.frame);
  probe_start_ = start ? *start : planner_.end_pose();
  probing_ = true;
  add_to_planner({probe_line_, canonical::Feed{probe_.target, probe_.frame, probe_.feed_per_s, 0}});
  drain(std::nullopt);
}

void JobPipeline::stands(const Pose& pose, Frame frame) {
  start_at(pose, frame, probe_line_);
  if (interpreter_) interpreter_->set_position(pose, frame);
}

void JobPipeline::input_read(double value) {
  if (interpreter_) interpreter_->set_input(value);
}

gcode::ProbeResult JobPipeline::assumed_probe() const {
  Pose at = probe_.target;
  const auto from = convert_pose(kinematics_, probe_.frame, probe_start_, Frame::kPart);
  const auto to = convert_pose(kinematics_, probe_.frame, probe_.target, Frame::kPart);
  if (from && to && (*from)[kZ] > 0 && (*to)[kZ] < 0) {
    const double share = (*from)[kZ] / ((*from)[kZ] - (*to)[kZ]);
    for (std::size_t axis = 0; axis < at.size(); ++axis)
      at[axis] = probe_start_[axis] + share * (probe_.target[axis] - probe_start_[axis]);
  }
  return {.contact = true, .at = at, .stand = at, .frame = probe_.frame};
}

void JobPipeline::probed(const gcode::ProbeResult& result) {
  probing_ = in_run_ = phase_waits_ = false;
  stage_ = Stage::kFeeding;
  // A and C are at 0, where both frames are the table's.
  if (result.contact)
    touched_.push_back({result.at[kX] + machine_.probe.offset_mm[0],
                        result.at[kY] + machine_.probe.offset_mm[1],
                        result.at[kZ] + machine_.probe.offset_mm[2]});
  if (touched_.size() > kMostTouched) touched_.erase(touched_.begin());
  start_at(result.stand, result.frame, probe_line_);
  if (interpreter_) interpreter_->set_probed(result);
}

}  // namespace kinebus
