// The commands: refused with a reason, or begun.

#include <algorithm>
#include <cmath>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {

using Done = Result<void, Refusal>;

Error<Refusal> refuse(Sentence words) {
  return Error<Refusal>(Refusal{std::move(words)});
}

/// Between two poses of a jog: the workspace is checked so often.
constexpr double kCheckStep = 1.0;  // mm
constexpr double kCheckStepRad = 0.01;
/// Nothing is under way there, but perhaps an interrupted job waits.
bool idle(MachineState state) {
  return state == MachineState::kOff || state == MachineState::kUnhomed || state == MachineState::kReady;
}

constexpr double kDefaultJogSpeed = 20;       // mm/s
constexpr double kDefaultTurnSpeed = 0.3;     // rad/s
constexpr double kDefaultExtrusionSpeed = 3;  // mm/s of filament

}  // namespace

Done Gateway::Core::check(MachineCommand command) const {
  if (!defect_.empty()) return refuse(defect_);
  const bool for_interrupted = (command == MachineCommand::kResume && state_ != MachineState::kHeld) ||
                               (command == MachineCommand::kCancel && idle(state_));
  if (allowed(command, state_) && for_interrupted && !interrupted())
    return refuse(say("there is no interrupted job to %1", sentence(command)));
  if (allowed(command, state_)) return {};
  const Sentence words = say("cannot %1 while the machine is %2", sentence(command), sentence(state_));
  switch (state_) {
    case MachineState::kOff:
      return refuse(say("%1: bring it up first", words));
    case MachineState::kUnhomed:
      return refuse(say("%1: home it first", words));
    case MachineState::kStopped:
    case MachineState::kAlarm:
      return refuse(say("%1: clear first", words));
    default:
      return refuse(words);
  }
}

Done Gateway::Core::bring_up() {
  going_on_ = false;
  return begin_bring_up();
}

Done Gateway::Core::begin_bring_up() {
  if (auto ok = check(MachineCommand::kBringUp); !ok) return ok;
  need_bring_up_ = fault_ = stream_lost_ = homed_ = false;
  hand_.drop();
  tau_before_ = rate_.tau(now_);
  bring_up_.start(now_, speaking_);
  enter(MachineState::kBringUp);
  return {};
}

Done Gateway::Core::home() {
  if (auto ok = check(MachineCommand::kHome); !ok) return ok;
  going_on_ = false;
  begin_homing();
  return {};
}

void Gateway::Core::begin_homing() {
  homed_ = false;
  homing_.start(now_);
  enter(MachineState::kHoming);
}

Result<PoseVector, Refusal> Gateway::Core::machine_pose() const {
  PoseVector pose = kinematics_->bed_reference();
  if (const auto found = kinematics_->forward(Frame::kMachine, joints_now(), pose); !found)
    return refuse(say("no pose fits the joints' positions: %1", to_string(found.error())));
  return pose;
}

void Gateway::Core::start_move(canonical::Command move, const PoseVector& from) {
  if (!interrupted()) job_name_.clear();
  job_follows_ = returning_ = false;
  runner_ = &hand_;
  hand_.start_commands({{0, std::move(move)}}, from);
  hand_.set_override(override_);
  job_started_ = now_;
  enter(MachineState::kMoving);
}

Done Gateway::Core::go_to_reference() {
  if (auto ok = check(MachineCommand::kReference); !ok) return ok;
  const auto pose = machine_pose();
  if (!pose) return Error<Refusal>(pose.error());
  PoseVector target = kinematics_->bed_reference();
  target[kE] = (*pose)[kE];
  start_move(canonical::Traverse{target, canonical::Frame::kMachine}, *pose);
  return {};
}

Done Gateway::Core::jog(const JogRequest& request) {
  if (auto ok = check(MachineCommand::kJog); !ok) return ok;
  const auto from = machine_pose();
  if (!from) return Error<Refusal>(from.error());
  const PoseVector& d = request.delta;
  for (const double value : d)
    if (!std::isfinite(value)) return refuse(say("a jog needs numbers"));
  if (!std::isfinite(request.speed_per_s) || request.speed_per_s < 0)
    return refuse(say("a jog's speed is 0 or more"));
  const double mm = std::sqrt(d[kX] * d[kX] + d[kY] * d[kY] + d[kZ] * d[kZ]);
  const double rad = std::max(std::abs(d[kA]), std::abs(d[kC]));
  if (mm == 0 && rad == 0 && d[kE] == 0) return refuse(say("a jog needs a distance"));
  const HeaterDescription& hotend = machine_.thermal.hotend;
  if (d[kE] > 0 && hotend.present &&
      thermal_.heater(Heater::kHotend).actual_celsius < machine_.thermal.min_extrude_c)
    return refuse(say("the hotend is too cold to feed filament: %1 C",
                      std::lround(thermal_.heater(Heater::kHotend).actual_celsius)));
  const double steps = std::clamp(std::ceil(std::max(mm / kCheckStep, rad / kCheckStepRad)), 1.0, 2000.0);
  for (double i = 1; i <= steps && (mm > 0 || rad > 0); ++i) {
    PoseVector pose = *from;
    for (std::size_t axis = 0; axis < kPoseAxes; ++axis) pose[axis] += d[axis] * i / steps;
    if (const auto fits = kinematics_->check(Frame::kMachine, pose); !fits)
      return refuse(kinematics_->check(Frame::kMachine, *from)
                        ? to_string(fits.error())
                        : say("%1: go to the bed reference first", to_string(fits.error())));
  }
  PoseVector target = *from;
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis) target[axis] += d[axis];
  double speed = request.speed_per_s;
  if (speed == 0) speed = mm > 0 ? kDefaultJogSpeed : rad > 0 ? kDefaultTurnSpeed : kDefaultExtrusionSpeed;
  start_move(canonical::Feed{.target = target, .frame = canonical::Frame::kMachine, .feed_per_s = speed},
             *from);
  return {};
}

Done Gateway::Core::run(std::unique_ptr<ByteSource> job, std::string name) {
  if (auto ok = check(MachineCommand::kRun); !ok) return ok;
  if (!job || !job->rewind())
    return refuse(say("the job cannot be read twice: it is checked before it runs"));
  give_up_job();
  job_ = std::make_unique<HashedSource>(std::move(job));
  job_name_ = std::move(name);
  problems_reported_ = 0;
  JobCheck::Options check_options;
  if (const double target = thermal_.heater(Heater::kHotend).target_celsius; target > 0)
    check_options.hotend_celsius = target;
  job_offsets_ = live_lines_.work_offsets();
  preflight_ = std::make_unique<Preflight>(machine_, *kinematics_, *job_, kinematics_->bed_reference(),
                                           check_options, job_offsets_);
  enter(MachineState::kChecking);
  return {};
}

Done Gateway::Core::hold() {
  if (auto ok = check(MachineCommand::kHold); !ok) return ok;
  held_from_ = state_;
  runner_->hold(now_);
  enter(MachineState::kHolding);
  return {};
}

Done Gateway::Core::resume() {
  if (auto ok = check(MachineCommand::kResume); !ok) return ok;
  by_itself_ = false;
  if (state_ != MachineState::kHeld || print_.suspended()) return go_on();
  if (heat_wanted_ && heat_wanted_->spindle_rpm != 0) {
    thermal_.set_spindle(heat_wanted_->spindle_rpm);
    spindle_first_ = true;
    return {};
  }
  runner_->resume(now_);
  enter(held_from_);
  return {};
}

Done Gateway::Core::cancel() {
  if (auto ok = check(MachineCommand::kCancel); !ok) return ok;
  if (state_ == MachineState::kChecking) {
    preflight_.reset();
    job_.reset();
    give_up_job();
    enter(MachineState::kReady);
    return {};
  }
  if (idle(state_)) {
    give_up_job();
    return {};
  }
  runner_->hold(now_);
  job_follows_ = returning_ = false;
  rest_since_ = now_;
  enter(MachineState::kCancelling);
  return {};
}

Done Gateway::Core::stop(Sentence why) {
  if (state_ == MachineState::kStopping || state_ == MachineState::kStopped || state_ == MachineState::kAlarm)
    return {};
  events_.message(now_, std::move(why));
  stop_all(false);
  return {};
}

Done Gateway::Core::clear() {
  if (auto ok = check(MachineCommand::kClear); !ok) return ok;
  if (need_bring_up_ || !speaking_) {
    fault_ = homed_ = false;
    hand_.drop();
    if (!print_.active()) job_name_.clear();
    events_.message(now_, print_.active()
                              ? say("cleared: resume brings the machine up again and goes on with the job")
                              : say("cleared: bring the machine up again"));
    enter(MachineState::kOff);
    return {};
  }
  if (clearing_ || standstill_.busy()) return {};
  rate_.clear(now_);
  clearing_ = true;
  clearing_since_ = next_repeat_ = now_;
  repeats_ = 0;
  return {};
}

Done Gateway::Core::set_feed_override(double ratio) {
  if (!(ratio >= 0.01 && ratio <= 5)) return refuse(say("a feed override is 0.01 to 5"));
  if (auto ok = check(MachineCommand::kFeedOverride); !ok) return ok;
  override_ = ratio;
  runner_->set_override(ratio);
  if (print_.active()) journal_.push(journal::Override{ratio});
  return {};
}

Done Gateway::Core::motors_off() {
  if (auto ok = check(MachineCommand::kMotorsOff); !ok) return ok;
  for (NodeLink& link : links_)
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis)
      link.set_control(axis, cia402::control::kShutdown);
  hand_.drop();
  interrupt(rate_.tau(now_));
  filament_lost_ = true;
  standstill_.abort();
  clearing_ = homed_ = false;
  enter(MachineState::kOff);
  return {};
}

Done Gateway::Core::set_temperature(bool bed, double celsius) {
  if (auto ok = check(MachineCommand::kThermal); !ok) return ok;
  const HeaterDescription& heater = bed ? machine_.thermal.bed : machine_.thermal.hotend;
  if (!heater.present) return refuse(say("this machine has no %1 heater", bed ? say("bed") : say("hotend")));
  if (!(celsius >= 0 && celsius <= heater.max_c))
    return refuse(say("the temperature must be 0 to %1 C", std::lround(heater.max_c)));
  thermal_.set_target(bed ? Heater::kBed : Heater::kHotend, celsius);
  if (heat_wanted_) (bed ? heat_wanted_->bed_celsius : heat_wanted_->hotend_celsius) = celsius;
  return {};
}

}  // namespace kinebus
