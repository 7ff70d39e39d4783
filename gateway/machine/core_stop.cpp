// From motion to rest and back: stops, and the standstill in which positions are read before anything moves
// again.

#include <utility>

#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// After path time has come to rest: the nodes' last status frames (100 ms apart) are here.
constexpr BusTime kSettle = 150ms;
/// A stop takes its ramp and no more; a node that does not say so is lost.
constexpr BusTime kStopTimeout = 3s;
constexpr BusTime kClearTimeout = 3s;

}  // namespace

void Gateway::Core::stop_all(bool fault) {
  fault_ = fault_ || fault;
  going_on_ = returning_ = false;
  bring_up_.abort();
  if (homing_.busy()) {
    homing_.abort();
    homed_ = false;
  }
  if (recovery_ && recovery_->replaying) {
    recovery_->job = print_.take_source();
    recovery_->replaying = false;
    print_.drop();
  } else if (recovery_ && job_) {
    recovery_->job = std::move(job_);
  }
  preflight_.reset();
  standstill_.abort();
  clearing_ = false;
  if (state_ == MachineState::kRunning || state_ == MachineState::kMoving) held_from_ = state_;
  if (speaking_ && !rate_.stop_latched()) rate_.stop(now_);
  // Whatever stopped the machine stops the cutter; a job that goes on gets it back first.
  const bool cutting = thermal_.spindle().target_rpm != 0;
  if (print_.active() && !heat_wanted_ && (fault_ || cutting)) heat_wanted_ = heat_noted_;
  thermal_.set_spindle(0);
  if (fault_) {
    thermal_.set_target(Heater::kHotend, 0);
    thermal_.set_target(Heater::kBed, 0);
  }
  if (state_ != MachineState::kAlarm && state_ != MachineState::kStopped) enter(MachineState::kStopping);
}

/// Path time stands, and for how long.
bool Gateway::Core::standing() {
  if (!rate_.at_rest(now_)) {
    rest_since_ = now_;
    return false;
  }
  return true;
}

void Gateway::Core::step_stop() {
  const bool rest = standing();
  if (rest && now_ - rest_since_ >= kSettle && now_ - entered_ >= kSettle)
    return enter(fault_ ? MachineState::kAlarm : MachineState::kStopped);
  if (now_ - entered_ < kStopTimeout) return;
  alarm(AlarmCode::kStopTimeout, say("path time did not come to rest"));
  fault_ = need_bring_up_ = true;
  enter(MachineState::kAlarm);
}

/// After clear(): the latch is lifted on all nodes, then the run can go on, or its rest is dropped.
void Gateway::Core::step_clear() {
  if (standstill_.busy()) return step_standstill();
  if (!clearing_) return;
  bool lifted = !rate_.stop_latched() && now_ - clearing_since_ >= kSettle;
  bool enabled = true, together = true;
  const auto units = static_cast<std::uint32_t>(rate_.tau(now_).count() / kPathTicksPerUnit);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    NodeLink& link = links_[i];
    if (link.stream() && (link.stream()->flags & StreamStatus::kStopped) != 0) lifted = false;
    together = together && link.stream() && link.stream()->path_units == units;
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
      if (axes_[i].axes[axis].joint < 0) continue;
      const cia402::State drive = link.drive_state(axis);
      const bool follows = drive == cia402::State::kOperationEnabled;
      enabled = enabled && follows;
      constexpr auto kMode = static_cast<std::int8_t>(cia402::Mode::kInterpolatedPosition);
      if (follows)
        link.set_control(axis, cia402::control::kOperation | cia402::control::kInterpolationEnable, kMode);
      else if (drive != cia402::State::kFault || (repeats_ & 1) != 0)
        link.set_control(axis, cia402::next_controlword(drive), kMode);
      else
        link.set_control(axis, 0, kMode);
    }
  }
  if (now_ >= next_repeat_) {
    next_repeat_ = now_ + 200ms;
    ++repeats_;
    for (NodeLink& link : links_) link.repeat_control();
  }
  if (lifted && enabled) {
    clearing_ = false;
    fault_ = false;
    // Nodes that rest elsewhere on the path than the gateway believes have missed something: what is queued
    // is dropped, and the job goes on from where they are.
    const bool goes_on = runner_->active() && !runner_->suspended() && !stream_lost_ && homed_ && together &&
                         state_ == MachineState::kStopped;
    if (!goes_on) return begin_standstill(After::kClear);
    runner_->hold(now_);
    return enter(MachineState::kHeld);
  }
  if (now_ - clearing_since_ < kClearTimeout) return;
  clearing_ = false;
  alarm(enabled ? AlarmCode::kStopTimeout : AlarmCode::kEnableFailed,
        enabled ? say("a node keeps its stop latched: is an emergency stop or a limit switch still active?")
                : say("a drive does not enable again: its fault is still there"));
}

void Gateway::Core::step_cancel() {
  if (standstill_.busy()) return step_standstill();
  if (!standing()) return;
  if (now_ - rest_since_ >= kSettle) begin_standstill(After::kCancel);
}

void Gateway::Core::begin_standstill(After after) {
  after_ = after;
  standstill_.start(rate_.tau(now_));
}

void Gateway::Core::step_standstill() {
  const Standstill::Outcome outcome = standstill_.on_time();
  if (outcome == Standstill::Outcome::kBusy) return;
  if (outcome == Standstill::Outcome::kDone) return finish_standstill();
  need_bring_up_ = true;
  alarm(standstill_.failure().code, standstill_.failure().words, standstill_.failure().node);
  if (state_ == MachineState::kAlarm) return;
  fault_ = true;
  enter(MachineState::kAlarm);
}

/// Positions are read and queues are empty: every motion can begin from here.
void Gateway::Core::finish_standstill() {
  group_.cancel();
  for (std::size_t i = 0; i < links_.size(); ++i)
    group_.set_state(links_[i].id(), standstill_.node(i).position, standstill_.node(i).stream);
  if (after_ == After::kHoming) group_.homed();
  homed_ = standstill_.positions_known();
  const bool cancelled = after_ == After::kCancel, job_failed = std::exchange(job_failed_, false);
  stream_lost_ = fault_ = false;
  hand_.drop();
  for (std::size_t i = 0; i < links_.size(); ++i) positions_[i] = standstill_.node(i).position;
  if (after_ == After::kHoming && !homed_) {
    alarm(AlarmCode::kHomingFailed, say("a node does not know its position after homing"));
    return stop_all(true);
  }
  if (cancelled || job_failed)
    give_up_job();
  else
    interrupt(after_ == After::kBringUp ? found_tau(print_.run_start(), tau_before_)
                                        : standstill_.path_time());
  if (!interrupted()) job_name_.clear();
  filament_lost_ = filament_lost_ || (interrupted() && !homed_);
  if (after_ == After::kHoming)
    events_.push({.kind = MachineEvent::Kind::kFinished, .when = now_, .words = say("homed"), .advice = {}});
  if (after_ == After::kCancel) events_.message(now_, say("cancelled: positions are known"));
  // What was interrupted by a stop alone is held; elsewhere the machine may be moved first.
  if (after_ == After::kClear && homed_ && print_.active()) return enter(MachineState::kHeld);
  enter(homed_ ? MachineState::kReady : MachineState::kUnhomed);
  if (going_on_) finish_recovery();
}

}  // namespace kinebus
