// What each state of the machine does as time passes.

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr BusTime kJournalPatience = 500ms;
/// SYNC comes often until the clocks agree, and grows rare by steps: after a jump from 5 to 50 ms the line
/// through the window's old, dense end would hang on few recent samples. Latency 20 us, three nodes, worst
/// instant of a run in a hundred: 1.8 us apart with the jump, 1.0 us with these steps.
struct SyncPace {
  BusTime until;  ///< since SYNC began, or the last bring-up ended
  BusTime period;
};
constexpr SyncPace kSyncPaces[] = {{6s, 5ms}, {9s, 10ms}, {18s, 25ms}};

BusTime sync_period_at(BusTime age, BusTime usual) {
  for (const SyncPace& pace : kSyncPaces)
    if (age < pace.until) return std::min(pace.period, usual);
  return usual;
}

}  // namespace

void Gateway::Core::enter(MachineState state) {
  if (state == state_) return;
  // A program error, and no state to go on from: the daemon ends, and the nodes stop on the path by
  // themselves.
  if (!may_follow(state_, state)) std::abort();
  state_ = state;
  spindle_first_ = false;
  entered_ = now_;
  events_.push({.kind = MachineEvent::Kind::kState,
                .when = now_,
                .state = state,
                .words = sentence(state),
                .advice = {}});
}

void Gateway::Core::alarm(AlarmCode code, Sentence words, std::uint8_t node, std::uint32_t line) {
  events_.alarm(now_, code, std::move(words), node, line);
}

void Gateway::Core::on_bus_failure(BusTime now, std::string_view what) {
  now_ = std::max(now_, now);
  if (need_bring_up_ && state_ == MachineState::kAlarm) return;
  need_bring_up_ = true;
  if (state_ == MachineState::kOff) return;
  alarm(AlarmCode::kBusFailure, say("the bus failed: %1", what));
  stop_all(true);
}

void Gateway::Core::on_time(BusTime now) {
  served_ = now_ = std::max(now_, now);
  load_.advance(now_);
  rate_.on_time(now_);
  thermal_.on_time(now_);
  for (NodeLink& link : links_) link.on_time(now_);
  watch_nodes();
  note_progress();
  const BusTime sync_period = sync_period_at(bring_up_.busy() ? 0s : now_ - spoke_, machine_.bus.sync_period);
  if (sync_period != sync_.period()) sync_.set_period(sync_period, now_);
  switch (state_) {
    case MachineState::kBringUp:
      step_bring_up();
      break;
    case MachineState::kHoming:
      step_homing();
      break;
    case MachineState::kChecking:
      step_checking();
      break;
    case MachineState::kMoving:
    case MachineState::kRunning:
      step_running();
      break;
    case MachineState::kHolding:
      step_hold();
      break;
    case MachineState::kCancelling:
      step_cancel();
      break;
    case MachineState::kStopping:
      step_stop();
      break;
    case MachineState::kStopped:
    case MachineState::kAlarm:
      step_clear();
      break;
    case MachineState::kOff:
      try_by_itself();
      break;
    case MachineState::kHeld:
      step_held();
      break;
    case MachineState::kUnhomed:
    case MachineState::kReady:
      break;
  }
}

// Bring-up and homing
// ------------------------------------------------------------------------------------------

void Gateway::Core::step_bring_up() {
  if (standstill_.busy()) return step_standstill();
  // What was found is on the disk before the nodes lose it.
  if (found_noted_ && !journal_.all_stored() && now_ - *found_noted_ < kJournalPatience) return;
  const BringUp::Outcome outcome = bring_up_.on_time(now_);
  if (bring_up_.may_speak() && !speaking_) {
    speaking_ = true;
    spoke_ = now_;
    sync_.start(now_);
    heartbeat_.set_period(machine_.bus.heartbeat_period, now_);
  }
  note_found();
  if (outcome == BringUp::Outcome::kBusy) return;
  if (outcome == BringUp::Outcome::kDone) {
    spoke_ = now_;  // a node that was restarted has few SYNCs yet
    return begin_standstill(After::kBringUp);
  }
  const StepFailure& failure = bring_up_.failure();
  if (failure.code == AlarmCode::kSecondGateway) speaking_ = false;
  need_bring_up_ = true;
  going_on_ = false;
  alarm(failure.code, failure.words, failure.node);
  enter(MachineState::kAlarm);
}

void Gateway::Core::step_homing() {
  if (standstill_.busy()) return step_standstill();
  const MachineHoming::Outcome outcome = homing_.on_time(now_);
  if (outcome == MachineHoming::Outcome::kBusy) return;
  if (outcome == MachineHoming::Outcome::kDone) return begin_standstill(After::kHoming);
  alarm(homing_.failure().code, homing_.failure().words, homing_.failure().node);
  stop_all(true);
}

// Jobs and moves
// -----------------------------------------------------------------------------------------------

void Gateway::Core::report_problems() {
  const auto& problems = preflight_->problems().all();
  for (; problems_reported_ < problems.size(); ++problems_reported_) {
    const Problem& problem = problems[problems_reported_];
    const bool error = problem.severity == Problem::Severity::kError;
    events_.push({.kind = MachineEvent::Kind::kProblem,
                  .when = now_,
                  .line = problem.line,
                  .words = error ? say("error: %1", problem.words) : say("warning: %1", problem.words),
                  .advice = {}});
  }
}

void Gateway::Core::step_checking() {
  if (recovery_) return step_recovery();
  const bool done = preflight_->step(options_.planning_budget);
  report_problems();
  if (!done) return;
  job_report_ = preflight_->report();
  const std::uint64_t errors = preflight_->problems().errors();
  preflight_.reset();
  job_bytes_ = job_->bytes();
  job_hash_ = job_->hash();
  if (errors > 0 || !job_->rewind()) {
    events_.push({.kind = MachineEvent::Kind::kFinished,
                  .when = now_,
                  .words = say("the job was not begun: it has %1 errors", errors),
                  .advice = say("correct the lines named, then run it again")});
    job_.reset();
    job_name_.clear();
    return enter(MachineState::kReady);
  }
  const auto pose = machine_pose();
  if (!pose) {
    alarm(AlarmCode::kJobError, pose.error().words);
    return stop_all(true);
  }
  PoseVector target = kinematics_->bed_reference();
  target[kE] = (*pose)[kE];
  runner_ = &hand_;
  hand_.start_commands({{0, canonical::Traverse{target, canonical::Frame::kMachine}}}, *pose);
  hand_.set_override(override_);
  job_follows_ = true;
  job_started_ = now_;
  enter(MachineState::kRunning);
}

void Gateway::Core::step_running() {
  switch (runner_->on_time(now_, options_.planning_budget)) {
    case Runner::Outcome::kBusy:
      return;
    case Runner::Outcome::kPaused:
      held_from_ = state_;
      enter(MachineState::kHolding);
      return enter(MachineState::kHeld);
    case Runner::Outcome::kDone:
      return finish_motion();
    case Runner::Outcome::kEmergencyStop:
      alarm(AlarmCode::kEmergencyStop, say("M112 in the job"), 0, runner_->line(now_));
      return stop_all(false);
    case Runner::Outcome::kFailed: {
      const Runner::Failure& failure = runner_->failure();
      stream_lost_ = true;
      job_failed_ = runner_ == &print_ && !failure.stream;
      alarm(failure.stream ? AlarmCode::kStreamLost : AlarmCode::kJobError, failure.words, 0, failure.line);
      return stop_all(false);
    }
  }
}

void Gateway::Core::finish_motion() {
  const bool live = runner_->live();
  if (runner_ == &print_) journal_.push(journal::JobEnd{});
  runner_->drop();
  remember_positions();
  if (std::exchange(returning_, false)) return finish_return();
  if (std::exchange(job_follows_, false)) {
    PoseVector start = kinematics_->bed_reference();
    if (const auto pose = machine_pose()) start[kE] = (*pose)[kE];
    begin_job(start);
    return;
  }
  const bool job = state_ == MachineState::kRunning;
  if (job) thermal_.set_spindle(0);  // the end of a program stops it (RS274/NGC 3.6.1)
  events_.push({.kind = MachineEvent::Kind::kFinished,
                .when = now_,
                .words = !job   ? say("move done")
                         : live ? say("all lines done: %1", job_name_)
                                : say("job done: %1", job_name_),
                .advice = {}});
  if (job) job_name_.clear();
  enter(MachineState::kReady);
}

void Gateway::Core::step_hold() {
  // A wait between runs stands still at once; planning ahead goes on.
  static_cast<void>(runner_->on_time(now_, options_.planning_budget));
  if (standing()) enter(MachineState::kHeld);
}

void Gateway::Core::step_held() {
  if (!spindle_first_ || !thermal_.spindle().at_speed()) return;
  heat_wanted_.reset();
  runner_->resume(now_);
  enter(held_from_);
}

}  // namespace kinebus
