// Pressure advance and input shaping of a job: the machine file's, until the job says others.

#include <algorithm>

#include "gateway/jobs/job_pipeline.hpp"
#include "gateway/jobs/job_shaping.hpp"
#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {
namespace {

bool has_extruder(const MachineDescription& machine) {
  return std::any_of(machine.joints.begin(), machine.joints.end(),
                     [](const JointDescription& joint) { return joint.name == "E"; });
}

}  // namespace

/// At rest: what comes next goes through a shaper for the advance in force.
void JobPipeline::begin_advance() {
  advances_.clear();
  const AdvanceWindow window = has_extruder(machine_) ? AdvanceWindow(advance_) : AdvanceWindow();
  shaper_ = MotionShaper(axis_shapers(vibration_), window, shaper_.filament_offset_mm());
  shaper_.set_advance(advance_);
  shaping_ = shaper_.active();
  limit_filament(advance_);
}

void JobPipeline::limit_filament(const AdvanceModel& model) {
  const FilamentLimits limits = limits_before_advance(machine_, vibration_, model, shaper_.advance_window());
  if (const auto limited = planner_.limit_filament(limits); !limited)
    refuse(line_of(limited.error().line), 0, to_string(limited.error()));
}

/// Another advance holds from the next move on, before which the path rests. Where the window changes, or
/// lines come one by one without numbers of their own, the run ends there.
bool JobPipeline::take_advance(const canonical::Line& line) {
  const auto* asked = std::get_if<canonical::PressureAdvance>(&line.command);
  if (asked == nullptr) return false;
  AdvanceModel next = advance_;
  if (asked->advance_s >= 0) next.advance_s = asked->advance_s;
  if (asked->smooth_s >= 0) next.smooth_s = std::max(asked->smooth_s, AdvanceModel::kLeastSmooth_s);
  if (next == advance_ || !has_extruder(machine_)) return true;
  const AdvanceWindow& window = shaper_.advance_window();
  const bool same_window = window.acts() && window.smooth_s == next.smooth_s;
  advance_ = next;
  if (!window.acts() && !next.acts()) return true;
  if (source_ == nullptr || !same_window) {
    drain(line);
    return true;
  }
  advances_.push_back({line.line, next});
  limit_filament(next);
  return true;
}

/// Shaped in another way from the next move on: the run ends there.
bool JobPipeline::take_shaping(const canonical::Line& line) {
  const auto* asked = std::get_if<canonical::InputShaping>(&line.command);
  if (asked == nullptr) return false;
  canonical::InputShaping all = asked_shaping_;
  merge_shaping(all, *asked);
  const auto next = shaped_by_job(kinematics_, machine_.vibration, all);
  if (!next) {
    refuse(line_of(line.line), 0, next.error());
    return true;
  }
  asked_shaping_ = all;
  const bool other = axis_shapers(*next) != axis_shapers(vibration_);
  vibration_ = *next;
  if (other) drain(line);
  return true;
}

/// At rest: the planner leaves what comes next the reserve of the shaper in force.
void JobPipeline::begin_shaping(std::uint32_t line) {
  planner_.limit_machine(limits_before_shaping(machine_, vibration_));
  start_at(planner_.end_pose(), planner_.end_frame(), line);
  begin_advance();
}

bool JobPipeline::push_planned() {
  if (!planner_.next(planned_)) return false;
  if (thread_.sync.rpm > 0) watch_thread(planned_);
  while (!advances_.empty() && advances_.front().line < planned_.line) {
    shaper_.set_advance(advances_.front().model);
    advances_.pop_front();
  }
  shaper_.push(planned_);
  return true;
}

void JobPipeline::check_shaped() {
  const auto excess = shaped_limits_.excess(phase_);
  if (excess && !over_limit_) {
    const JointDescription& joint = machine_.joints[static_cast<std::size_t>(excess->joint)];
    const std::string ratio = printed("%.3f", excess->ratio);
    refuse(
        line_of(phase_.line), 0,
        excess->acceleration
            ? say("shaped, this move asks %1 for %2 times its acceleration: lower the tool's acceleration, "
                  "or take a shorter shaper",
                  joint.name, ratio)
            : say("shaped, this move asks %1 for %2 times its speed: lower the tool's speed, or take a "
                  "shorter shaper",
                  joint.name, ratio));
  }
  over_limit_ = excess.has_value();
}

}  // namespace kinebus
