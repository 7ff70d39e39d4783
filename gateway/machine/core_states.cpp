// What each state of the machine does as time passes, and what it leads to.

#include <utility>

#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// A stop takes its ramp and no more; a node that does not say so is lost.
constexpr BusTime kStopTimeout = 3s;

}  // namespace

// Bring-up and homing
// ------------------------------------------------------------------------------------------

void Gateway::Core::begin_bring_up() {
  watch_.bring_up_begins();
  motors_.bring_up_begins(now_);
  parameters_.forget();
  remote_told_ = false;
  useless_.forget();
  fault_ = false;
  position_.forget();
  position_.stream_is_new();
  hand_.runner().drop();
  recovery_.bring_up_begins(rate_.tau(now_));
  devices_.on_bring_up(now_, false);
  session_.begin();
  bring_up_.start(now_, voice_.speaks(), session_.key_writes());
  enter(MachineState::kBringUp);
}

void Gateway::Core::step_bring_up() {
  if (rest_.reading()) return step_standstill();
  if (recovery_.waits_for_journal(now_)) return;
  const BringUp::Outcome outcome = bring_up_.on_time(now_);
  if (bring_up_.may_speak()) voice_.begin(now_);
  recovery_.note_found(now_, bring_up_);
  if (outcome == BringUp::Outcome::kBusy) return;
  if (outcome == BringUp::Outcome::kDone) {
    session_.settle();
    voice_.nodes_are_new(now_);
    devices_.on_bring_up(now_, true);
    if (const auto node = bring_up_.node_without_smooth_ramps())
      events_.message(now_,
                      say("the program of node %1 does not know smooth ramps: holds, resumes and changes "
                          "of the override exceed the limits of jerk until it is updated",
                          *node));
    return rest_.read(now_, Rest::After::kBringUp);
  }
  const StepFailure& failure = bring_up_.failure();
  if (failure.code == AlarmCode::kSecondGateway) voice_.end();
  watch_.lose();
  recovery_.do_not_go_on();
  events_.alarm(now_, failure.code, failure.words, failure.node);
  enter(MachineState::kAlarm);
}

void Gateway::Core::begin_homing() {
  position_.forget();
  homing_.start(now_);
  enter(MachineState::kHoming);
}

void Gateway::Core::step_homing() {
  if (rest_.reading()) return step_standstill();
  const MachineHoming::Outcome outcome = homing_.on_time(now_);
  if (outcome == MachineHoming::Outcome::kBusy) return;
  if (outcome == MachineHoming::Outcome::kDone) return rest_.read(now_, Rest::After::kHoming);
  const StepFailure& failure = homing_.failure();
  events_.alarm(now_, failure.code, failure.words, failure.node);
  stop_all(true);
}

// Jobs and moves
// -----------------------------------------------------------------------------------------------

void Gateway::Core::step_checking() {
  if (recovery_.left()) return step_recovery();
  if (!print_.check(now_, options_.planning_budget)) return;
  if (print_.errors() > 0 || !print_.rewind()) {
    events_.push({.kind = MachineEvent::Kind::kFinished,
                  .when = now_,
                  .words = say("the job was not begun: it has %1 errors", print_.errors()),
                  .advice = say("correct the lines named, then run it again")});
    print_.drop_source();
    print_.forget_name();
    return enter(MachineState::kReady);
  }
  const auto pose = machine_pose();
  if (!pose) {
    events_.alarm(now_, AlarmCode::kJobError, pose.error().words);
    return stop_all(true);
  }
  // Who begins a job has taken the last one off the table.
  if (printed_) printed_->clear();
  if (auto meet = hand_.in_the_way_to_reference(*pose)) {
    events_.push({.kind = MachineEvent::Kind::kFinished,
                  .when = now_,
                  .words = say("the job was not begun: on the way to the bed reference %1", std::move(*meet)),
                  .advice = say("move the tool clear by hand, then run it again")});
    print_.drop_source();
    print_.forget_name();
    return enter(MachineState::kReady);
  }
  runner_ = &hand_.runner();
  hand_.start({{0, hand_.reference(*pose)}}, *pose, override_, ManualMotion::Then::kJob);
  print_.begin_clock(now_);
  enter(MachineState::kRunning);
}

void Gateway::Core::step_running() {
  if (rest_.reading()) return step_standstill();
  if (runner_->live() && lines_.given_up(now_)) {
    events_.message(now_, say("the lines' host has gone: what is left of them is given up"));
    static_cast<void>(carry_out(command::Cancel{}));
    return;
  }
  if (state_.is(MachineState::kMoving) && hand_.let_go(now_)) return end_jog();
  const Runner::Outcome outcome = runner_->on_time(now_, options_.planning_budget);
  for (const Runner::Answer& answer : runner_->take_answers())
    if (answer.probed)
      lines_.probed(*answer.probed);
    else if (answer.input)
      lines_.input_read(*answer.input);
    else
      lines_.levelled(answer.stand);
  switch (outcome) {
    case Runner::Outcome::kBusy:
      return;
    case Runner::Outcome::kProbed:
      return step_probed();
    case Runner::Outcome::kPaused:
      held_from_ = state_.now();
      enter(MachineState::kHolding);
      enter(MachineState::kHeld);
      // Lines of a host are the host's to go on with.
      if (runner_->changes_filament() && !runner_->live())
        static_cast<void>(step_aside(HeatHold::Aside::kForFilament));
      return;
    case Runner::Outcome::kDone:
      return finish_motion();
    case Runner::Outcome::kEmergencyStop:
      events_.alarm(now_, AlarmCode::kEmergencyStop, say("M112 in the job"), 0, runner_->line(now_));
      cut_heat(say("M112 in the job"));
      return stop_all(false);
    case Runner::Outcome::kFailed:
      return fail_motion();
  }
}

void Gateway::Core::fail_motion() {
  const Runner::Failure& failure = runner_->failure();
  position_.lose_stream();
  if (runner_ == &print_.runner() && !failure.stream) recovery_.fail_job();
  events_.alarm(now_, failure.stream ? AlarmCode::kStreamLost : AlarmCode::kJobError, failure.words, 0,
                failure.line);
  stop_all(false, failure.stream);
}

void Gateway::Core::finish_motion() {
  const bool live = runner_->live();
  if (runner_ == &print_.runner()) journal_.push(journal::JobEnd{});
  runner_->drop();
  position_.take_run_end();
  switch (hand_.take_then()) {
    case ManualMotion::Then::kReturn:
      return finish_return();
    case ManualMotion::Then::kJob: {
      Pose start = kinematics_->bed_reference();
      if (const auto pose = machine_pose()) start[kE] = (*pose)[kE];
      return begin_job(start);
    }
    case ManualMotion::Then::kHeld:
      return finish_lift();
    case ManualMotion::Then::kNothing:
      break;
  }
  const bool job = state_.is(MachineState::kRunning);
  if (const auto next = job ? std::nullopt : hand_.take_jog())
    if (const auto from = machine_pose()) return begin_move(*next, *from);
  hand_.end_jogs();
  if (job) heat_.stop_spindle();  // the end of a program stops it (RS274/NGC 3.6.1)
  events_.push({.kind = MachineEvent::Kind::kFinished,
                .when = now_,
                .words = !job   ? say("move done")
                         : live ? say("all lines done: %1", print_.name())
                                : say("job done: %1", print_.name()),
                .advice = {}});
  if (job) print_.forget_name();
  if (job && !live) end_override();
  enter(MachineState::kReady);
}

void Gateway::Core::step_hold() {
  if (rest_.reading()) return step_standstill();
  if (!heat_hold_.is(HeatHold::Stage::kNone)) return step_heat_hold();
  // A wait between runs stands still at once; planning ahead goes on.
  const Runner::Outcome outcome = runner_->on_time(now_, options_.planning_budget);
  if (outcome == Runner::Outcome::kFailed && runner_->cuts_thread()) return fail_motion();
  if (rest_.standing(now_)) enter(MachineState::kHeld);
}

void Gateway::Core::step_held() {
  if (heat_hold_.is(HeatHold::Stage::kMends)) return step_mending();
  if (!recovery_.awaits_spindle(state_.visit()) || !heat_.spindle_at_speed()) return;
  heat_.forget_kept();
  runner_->resume(now_);
  enter(held_from_);
}

// Stops, and the standstill in which positions are read before anything moves again
// -----------------------------------------------------------------------------------------------

void Gateway::Core::stop_all(bool fault, bool by_absence) {
  stall_.on_stop(now_, by_absence);
  fault_ = fault_ || fault;
  recovery_.do_not_go_on();
  give_up_probing();
  give_up_thread();
  heat_hold_.abort();
  if (hand_.leads_to(ManualMotion::Then::kReturn) || hand_.leads_to(ManualMotion::Then::kHeld))
    hand_.forget_then();
  hand_.end_jogs();
  // Nodes that are half configured are brought up anew; what they say until then is no news.
  if (bring_up_.busy()) watch_.lose();
  bring_up_.abort();
  if (homing_.busy()) {
    homing_.abort();
    position_.forget();
  }
  if (auto& left = recovery_.left(); left && left->replaying) {
    left->job = print_.runner().take_source();
    left->replaying = false;
    print_.runner().drop();
  } else if (left) {
    if (auto source = print_.take_source()) left->job = std::move(source);
  }
  print_.abort_check();
  rest_.abort();
  clearing_.abort();
  if (state_.is_one_of(MachineState::kRunning, MachineState::kMoving)) held_from_ = state_.now();
  if (voice_.speaks() && !rate_.stop_latched()) rate_.stop(now_);
  // Whatever stopped the machine stops the cutter; a job that goes on gets it back first.
  if (print_.runner().active() && (fault_ || heat_.spindle_on())) heat_.keep();
  heat_.stop_spindle();
  if (fault_) heat_.heaters_off(std::exchange(beds_stay_, false) ? Heat::Beds::kStay : Heat::Beds::kOff);
  if (!state_.is_one_of(MachineState::kAlarm, MachineState::kStopped)) enter(MachineState::kStopping);
}

void Gateway::Core::step_stop() {
  if (rest_.settled(now_) && now_ - state_.since() >= Rest::kSettle) {
    if (const auto why = homing_.explain()) events_.alarm(now_, why->code, why->words, why->node);
    return enter(fault_ ? MachineState::kAlarm : MachineState::kStopped);
  }
  if (now_ - state_.since() < kStopTimeout) return;
  events_.alarm(now_, AlarmCode::kStopTimeout, say("path time did not come to rest"));
  fault_ = true;
  watch_.lose();
  enter(MachineState::kAlarm);
}

/// After clear the run can go on, or its rest is dropped.
void Gateway::Core::step_clear() {
  if (rest_.reading()) return step_standstill();
  if (!clearing_.busy()) return;
  switch (clearing_.on_time(now_)) {
    case Clearing::Outcome::kBusy:
      return;
    case Clearing::Outcome::kFailed:
      return events_.alarm(now_, clearing_.failure().code, clearing_.failure().words);
    case Clearing::Outcome::kLifted:
      break;
  }
  fault_ = false;
  // A job whose heaters went off heats on its way back.
  const bool goes_on = runner_->active() && !print_.runner().suspended() && !position_.stream_lost() &&
                       position_.homed() && clearing_.together() && !heat_.kept_heat() &&
                       state_.is(MachineState::kStopped);
  if (!goes_on) return rest_.read(now_, Rest::After::kClear);
  runner_->hold(now_);
  enter(MachineState::kHeld);
}

/// Clears what the gateway's own absence has caused, and goes on with the job, where the machine file says
/// so.
void Gateway::Core::step_after_stall() {
  const bool stopped =
      state_.is_one_of(MachineState::kStopping, MachineState::kStopped, MachineState::kAlarm);
  if (stopped && (state_.is(MachineState::kStopping) || rest_.reading() || clearing_.busy())) return;
  if (!stopped && !state_.is_one_of(MachineState::kOff, MachineState::kReady, MachineState::kHeld)) return;
  switch (stall_.next(now_, state_.since(), stopped)) {
    case StallRecovery::Step::kNone:
      return;
    case StallRecovery::Step::kClear:
      if (print_.runner().active()) {
        command::Clear clear;
        static_cast<void>(on(clear));
      }
      return;
    case StallRecovery::Step::kGoOn:
      if (const Done done = may(command::kind<command::Resume>); !done) return;
      events_.message(now_, say("the gateway is back: the job goes on by itself"));
      recovery_.goes_by_itself();
      static_cast<void>(resume());
      return;
  }
}

void Gateway::Core::step_cancel() {
  if (rest_.reading()) return step_standstill();
  // The end of a jog that was held cancels nothing.
  if (rest_.settled(now_))
    rest_.read(now_,
               hand_.jogs() == ManualMotion::Jogs::kWhileHeld ? Rest::After::kJog : Rest::After::kCancel);
}

void Gateway::Core::step_standstill() {
  const Standstill::Outcome outcome = rest_.on_time();
  if (outcome == Standstill::Outcome::kBusy) return;
  if (outcome == Standstill::Outcome::kDone) return finish_standstill();
  watch_.lose();
  events_.alarm(now_, rest_.failure().code, rest_.failure().words, rest_.failure().node);
  if (state_.is(MachineState::kAlarm)) return;
  fault_ = true;
  enter(MachineState::kAlarm);
}

/// Positions are read and queues are empty: every motion can begin from here.
void Gateway::Core::finish_standstill() {
  using After = Rest::After;
  const After after = rest_.after();
  const Standstill& found = rest_.found();
  group_.cancel();
  for (std::size_t i = 0; i < axes_.size(); ++i)
    group_.set_state(links_[i].id(), found.node(i).position, found.node(i).stream);
  if (after == After::kHoming) group_.homed();
  position_.take(found);
  if (after == After::kProbe) return finish_probe();
  const bool cancelled = after == After::kCancel, job_failed = recovery_.take_job_failed();
  fault_ = false;
  hand_.runner().drop();
  hand_.end_jogs();
  if (after == After::kHoming && !position_.homed()) {
    events_.alarm(now_, AlarmCode::kHomingFailed, say("a node does not know its position after homing"));
    return stop_all(true);
  }
  if (cancelled || job_failed)
    give_up_job();
  else
    interrupt(after == After::kBringUp ? recovery_.found_tau(bring_up_, print_.runner().run_start())
                                       : found.path_time());
  if (!interrupted()) print_.forget_name();
  if (interrupted() && !position_.homed()) recovery_.lose_filament();
  if (after == After::kHoming)
    events_.push({.kind = MachineEvent::Kind::kFinished, .when = now_, .words = say("homed"), .advice = {}});
  if (after == After::kJog)
    events_.push(
        {.kind = MachineEvent::Kind::kFinished, .when = now_, .words = say("move done"), .advice = {}});
  if (cancelled) events_.message(now_, say("cancelled: positions are known"));
  if (after == After::kHeatFault && position_.homed()) return begin_lift();
  // What was interrupted by a stop alone is held; elsewhere the machine may be moved first.
  if (after == After::kClear && position_.homed() && print_.runner().active())
    return enter(MachineState::kHeld);
  enter(position_.homed() ? MachineState::kReady : MachineState::kUnhomed);
  if (recovery_.going_on()) finish_recovery();
}

}  // namespace kinebus
