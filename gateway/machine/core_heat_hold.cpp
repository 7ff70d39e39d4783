// A heater's fault in a job, or filament that does not come: held on the path, lifted off the part, and gone
// on with when it is mended.

#include <utility>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/core.hpp"

namespace kinebus {

using Stage = HeatHold::Stage;

/// A device that is out of order has switched itself off; whatever it was needed for must not go on.
void Gateway::Core::watch_devices() {
  while (const auto fault = heat_.new_fault()) {
    tell(*fault);
    if (state_.is(MachineState::kOff) || hold_for_heat(*fault) || homes_without(*fault)) continue;
    beds_stay_ = true;
    stop_all(true);
  }
  if (!heat_hold_.is_put_off()) return;
  Runner& job = print_.runner();
  if (!job.active() || !state_.is_one_of(MachineState::kRunning, MachineState::kHolding, MachineState::kHeld))
    return heat_hold_.abort();
  if (job.probing() || job.cuts_thread()) return job.keep_still();
  const DeviceFault fault = *heat_hold_.is_put_off();
  heat_hold_.abort();
  hold_for(fault);
}

/// What is homed feeds nothing: it comes to where positions are known, and a job that waits for it says why
/// it does not go on.
bool Gateway::Core::homes_without(const DeviceFault& fault) {
  if (!fault.heater || !state_.is(MachineState::kHoming)) return false;
  if (print_.runner().active()) heat_.keep();
  heat_.heaters_off(Heat::Beds::kStay);
  return true;
}

/// False: no job is under way that could be held.
bool Gateway::Core::hold_for_heat(const DeviceFault& fault) {
  const bool of_job = print_.runner().active() &&
                      state_.is_one_of(MachineState::kRunning, MachineState::kHolding, MachineState::kHeld);
  if (!fault.heater || !of_job) return false;
  heat_.note(journal_);
  heat_.keep();
  heat_.heaters_off(Heat::Beds::kStay);
  if (print_.runner().probing() || print_.runner().cuts_thread())
    heat_hold_.put_off(fault);
  else
    hold_for(fault);
  return true;
}

/// A job feeds nothing that is not there. Without one it is nobody's trouble yet. Heaters stay as they are:
/// what is put in is to melt.
void Gateway::Core::watch_filament() {
  const bool of_job = state_.is(MachineState::kRunning) && runner_ == &print_.runner() && runner_->active();
  if (!of_job || runner_->probing() || !heat_hold_.is(Stage::kNone)) return;
  const auto trouble = heat_.filament_trouble();
  if (!trouble) return;
  tell(*trouble);
  heat_.note(journal_);
  heat_.keep();
  hold_for(*trouble);
}

/// Whatever has made it so: a target that was lowered by hand, a heater that is too weak.
void Gateway::Core::watch_cold_feed() {
  if (!state_.is_one_of(MachineState::kRunning, MachineState::kMoving) || rest_.reading()) return;
  if (!heat_hold_.is(Stage::kNone) || !runner_->feeds_cold(now_)) return;
  const DeviceFault cold = heat_.feeds_cold();
  if (runner_ == &print_.runner()) {
    tell(cold);
    heat_.note(journal_);
    heat_.keep();
    return hold_for(cold);
  }
  // By hand nothing is lost.
  if (!state_.is(MachineState::kMoving)) return;
  events_.message(now_, say("%1: %2", cold.device, cold.words));
  static_cast<void>(carry_out(command::Cancel{}));
}

void Gateway::Core::tell(const DeviceFault& fault) {
  events_.alarm(now_, fault.filament ? AlarmCode::kFilament : AlarmCode::kThermal,
                say("%1: %2", fault.device, fault.words), fault.node,
                fault.filament ? runner_->line(now_) : 0);
}

std::optional<DeviceFault> Gateway::Core::out_of_order() const {
  auto fault = heat_.fault();
  return fault ? fault : heat_.filament_trouble();
}

void Gateway::Core::hold_for(const DeviceFault& fault) {
  heat_hold_.note(fault);
  if (heat_hold_.is(Stage::kMends)) heat_hold_.holds();
  if (!heat_hold_.is(Stage::kNone)) return;
  recovery_.do_not_go_on();
  hand_.forget_then();
  hand_.end_jogs();
  runner_->hold_still(now_);
  rest_.begin(now_);
  heat_hold_.begin();
  enter(MachineState::kHolding);
}

void Gateway::Core::step_heat_hold() {
  const Runner::Outcome outcome = runner_->on_time(now_, options_.planning_budget);
  if (heat_hold_.is(Stage::kStops)) {
    if (rest_.settled(now_)) rest_.read(now_, Rest::After::kHeatFault);
    return;
  }
  if (outcome == Runner::Outcome::kDone) return finish_motion();
  if (outcome != Runner::Outcome::kFailed) return;
  const Runner::Failure& failure = runner_->failure();
  position_.lose_stream();
  events_.alarm(now_, failure.stream ? AlarmCode::kStreamLost : AlarmCode::kJobError, failure.words);
  stop_all(false);
}

/// The job's place is kept, the tool stands on it. A job that was on its way back is lifted no higher.
void Gateway::Core::begin_lift() {
  runner_ = &print_.runner();
  const PlannedPose place = runner_->rest_pose();
  const auto on_part = convert_pose(*kinematics_, place.frame, place.pose, Frame::kMachine);
  const auto from = machine_pose();
  std::optional<Sentence> kept_from;
  std::optional<canonical::Command> up;
  const bool aside = heat_hold_.aside() != HeatHold::Aside::kNo;
  const double lift_mm = aside ? machine_.pause.lift_mm : machine_.thermal.lift_mm;
  if (on_part && from && lift_mm > 0) up = hand_.lift(*from, (*on_part)[kZ] + lift_mm, kept_from);
  if (kept_from) events_.message(now_, say("the tool is not lifted as far as it should be: %1", *kept_from));
  std::vector<canonical::Line> moves;
  if (up) moves.push_back({0, std::move(*up)});
  if (aside && from) add_parking(*from, moves);
  if (moves.empty()) return finish_lift();
  heat_hold_.lifts();
  runner_ = &hand_.runner();
  hand_.start(std::move(moves), *from, 1, ManualMotion::Then::kHeld);
}

void Gateway::Core::finish_lift() {
  if (heat_hold_.aside() != HeatHold::Aside::kNo) return finish_aside();
  runner_ = &print_.runner();
  heat_hold_.holds();
  heat_.stop_spindle();
  const PlannedPose place = runner_->rest_pose();
  const auto on_part = convert_pose(*kinematics_, place.frame, place.pose, Frame::kPart);
  const Pose& at = on_part ? *on_part : place.pose;
  events_.message(now_,
                  say("the job is held at X%1 Y%2 Z%3: mend what is wrong, then resume heats and goes on",
                      printed("%.3f", at[kX]), printed("%.3f", at[kY]), printed("%.3f", at[kZ])),
                  place.line);
  enter(MachineState::kHeld);
}

/// In kHeld, after resume.
void Gateway::Core::step_mending() {
  const auto fault = out_of_order();
  switch (heat_hold_.mended(now_, fault.has_value())) {
    case HeatHold::Mended::kNotYet:
      return;
    case HeatHold::Mended::kNo:
      heat_hold_.holds();
      if (fault) tell(*fault);
      return;
    case HeatHold::Mended::kYes:
      break;
  }
  heat_hold_.holds();
  recovery_.go_on();
  finish_recovery();
}

}  // namespace kinebus
