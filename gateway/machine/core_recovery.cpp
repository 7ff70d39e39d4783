// Interrupted jobs: what is kept of them, and how they go on from exactly their place.

#include <algorithm>
#include <utility>

#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {
using Done = Result<void, Refusal>;
}  // namespace

bool Gateway::Core::interrupted() const {
  const Runner& job = print_.runner();
  const bool nodes_lost = state_.is_one_of(MachineState::kOff, MachineState::kBringUp);
  return recovery_.left() || (job.active() && (job.suspended() || nodes_lost));
}

void Gateway::Core::interrupt(PathTime tau) {
  hand_.forget_then();
  print_.runner().suspend(tau);
}

Done Gateway::Core::recover(journal::State state, std::unique_ptr<ByteSource> job) {
  if (!state_.is(MachineState::kOff) || print_.runner().active())
    return refused(say("too late: the machine is in use already"));
  lines_.restart(state.offsets_of(identity(machine_)));
  bed_.take_up(now_, state);
  if (!state.job) return {};
  if (!job) return refused(say("the interrupted job %1 is not there any more", state.job->name));
  print_.rename(state.job->name);
  if (state.override_ratio) override_ = std::clamp(*state.override_ratio, 0.01, 5.0);
  if (state.time) print_.stop_clock_at(state.time->elapsed_s);
  heat_.take_up(state.heat);
  recovery_.take_up(std::move(state), std::move(job));
  events_.message(now_, say("the job %1 was interrupted: resume to go on with it, or cancel", print_.name()));
  return {};
}

void Gateway::Core::begin_job(const Pose& start) {
  runner_ = &print_.runner();
  journal_.push(print_.record(start));
  if (const MeshGrid* const mesh = bed_.in_force())
    journal_.push(journal::Learned{
        .what = journal::Learned::What::kBeginning, .at = start, .stand = start, .mesh = *mesh});
  heat_.begin_job();
  recovery_.job_begins();
  position_.show_filament_less(0);
  print_.start(start);
  runner_->set_override(override_);
  journal_.push(journal::Override{override_});
}

void Gateway::Core::give_up_job() {
  Runner& job = print_.runner();
  const bool had_one = job.active() || recovery_.left();
  if (had_one) journal_.push(journal::JobEnd{});
  recovery_.left().reset();
  if (job.active()) heat_.stop_spindle();
  job.drop();
  heat_.forget_kept();
  // Nobody has to clear before the next job: what is still out of order says so again.
  if (!heat_hold_.why().empty()) heat_.clear_faults();
  heat_hold_.forget();
  recovery_.do_not_go_on();  // nor what is cancelled on its way back
  print_.forget_name();
  if (had_one) end_override();
}

/// A feed override is for the job in which it was set, or the one that is next.
void Gateway::Core::end_override() {
  if (override_ == 1) return;
  override_ = 1;
  runner_->set_override(1);
  events_.message(now_, say("the feed is as programmed again"));
}

/// Targets, and now and then the place, as the job goes on.
void Gateway::Core::note_progress() {
  if (!print_.runner().active() || heat_.kept()) return;
  heat_.note(journal_);
  if (const double top_mm = printed_top_mm(); printed_ && print_.growth_is_due(top_mm))
    journal_.push(journal::Printed{top_mm});
  if (!print_.progress_is_due(now_, rate_.rate(now_) != 0)) return;
  const Runner& job = print_.runner();
  journal_.push(journal::Progress{group_.confirmed(rate_.tau(now_)), job.line(now_), joints_now()});
  journal_.push(
      journal::JobTime{job.line(now_), print_.elapsed_s(now_), job.done_s(now_), print_.report().motion_s});
}

// Going on
// ---------------------------------------------------------------------------------------------------------

Done Gateway::Core::go_on() {
  if (!defect_.empty()) return refused(defect_);
  recovery_.go_on();
  Done done;
  if (state_.is(MachineState::kOff))
    begin_bring_up();
  else if (state_.is(MachineState::kUnhomed))
    done = may_home();
  else
    done = begin_return();
  if (done && state_.is(MachineState::kUnhomed)) begin_homing();
  if (!done) {
    recovery_.do_not_go_on();
  } else if (!print_.clock_runs()) {
    // Homing and heating again are time of the job.
    print_.begin_clock(now_, print_.elapsed_s(now_));
  }
  return done;
}

/// 0: nothing is printed, or nobody looks.
double Gateway::Core::printed_top_mm() const {
  return printed_ && !printed_->empty() ? printed_->top_mm() : 0;
}

/// Nobody takes a part that is to be gone on with off the table: of an interrupted job it stands there. Of
/// one that a gateway before has left the journal tells the height, or else the tool's place.
Done Gateway::Core::may_home() const {
  const double spared_mm = machine_.homing.spared_part_mm;
  if (spared_mm == 0 || !interrupted()) return {};
  double height_mm = printed_top_mm();
  if (const auto& left = recovery_.left(); left && left->state.printed) {
    height_mm = left->state.printed->top_mm;
  } else if (left && left->state.progress) {
    Pose pose = kinematics_->bed_reference();
    if (kinematics_->forward(Frame::kPart, left->state.progress->joints, pose)) height_mm = pose[kZ];
  }
  constexpr double kCell_mm = 1;  // of what is printed
  if (height_mm <= spared_mm + kCell_mm) return {};
  return refused(
      say("the part of the interrupted job is %1 mm high and homing spares %2 mm: cancel the job and take "
          "the part off the table, then home",
          printed("%.0f", height_mm), printed("%.6g", spared_mm)));
}

/// After bring-up or homing, on the way to the job's place.
void Gateway::Core::finish_recovery() {
  if (!position_.homed() && recovery_.must_ask_to_home()) {
    recovery_.do_not_go_on();
    return events_.message(now_,
                           say("the nodes have lost their positions: resume homes the machine and goes on"));
  }
  if (!position_.homed() && may_home()) return begin_homing();
  const auto broken = out_of_order();
  const Done begun = !position_.homed() ? may_home()
                     : broken           ? Done(refused(say("%1: %2", broken->device, broken->words)))
                                        : begin_return();
  if (begun) return;
  recovery_.do_not_go_on();
  events_.push({.kind = MachineEvent::Kind::kFinished,
                .when = now_,
                .words = say("the job does not go on: %1", begun.error().words),
                .advice = say("put right what is said, then resume")});
}

Done Gateway::Core::begin_return() {
  heat_hold_.abort();
  if (auto& left = recovery_.left()) {
    // Checked once more, then read up to its place.
    if (!left->job->rewind()) return refused(say("the interrupted job cannot be read"));
    print_.begin_check(std::move(left->job), heat_.kept_hotends(), left->state.job->offsets);
    enter(MachineState::kChecking);
    return {};
  }
  const auto from = machine_pose();
  if (!from) return Error<Refusal>(from.error());
  const auto moves = recovery_.way_back(print_.runner().rest_pose(), *from, position_);
  if (!moves) return Error<Refusal>(moves.error());
  if (auto meet = hand_.in_the_way(*from, *moves)) {
    // What is held cannot be moved by hand: the job stays interrupted, motors and positions as they are.
    if (state_.is(MachineState::kHeld)) enter(MachineState::kReady);
    return refused(say("on the way back to the job's place %1: move the tool clear by hand, then resume",
                       std::move(*meet)));
  }
  std::vector<canonical::Line> commands = heat_.lead_back();
  commands.insert(commands.end(), moves->begin(), moves->end());
  if (commands.empty()) {
    finish_return();
    return {};
  }
  runner_ = &hand_.runner();
  hand_.start(std::move(commands), *from, 1, ManualMotion::Then::kReturn);
  started_ = now_;
  enter(MachineState::kRunning);
  return {};
}

void Gateway::Core::step_recovery() {
  auto& left = recovery_.left();
  Runner& job = print_.runner();
  if (left->replaying) {
    switch (job.replay(options_.planning_budget)) {
      case Runner::Outcome::kBusy:
        return;
      case Runner::Outcome::kFailed:
        events_.alarm(now_, AlarmCode::kJobError, job.failure().words, 0, job.failure().line);
        give_up_job();
        bed_.put_back();
        return stop_all(false);
      default:
        break;
    }
    left.reset();
    job.set_override(override_);
    journal_.push(journal::Interrupted{job.place({}), job.extruder_shift_mm()});
    enter(MachineState::kReady);
    return finish_recovery();
  }
  if (!print_.check(now_, options_.planning_budget)) return;
  if (print_.errors() > 0 || !print_.is_the_text_of(*left->state.job) || !print_.rewind()) {
    events_.push(
        {.kind = MachineEvent::Kind::kFinished,
         .when = now_,
         .words = say("the job %1 is not the text that was interrupted: it does not go on", print_.name()),
         .advice = say("run it from its beginning")});
    print_.drop_source();
    give_up_job();
    return enter(MachineState::kReady);
  }
  left->replaying = true;
  print_.replay(left->state, recovery_.left_tau());
}

/// The tool stands where the job goes on.
void Gateway::Core::finish_return() {
  Runner& job = print_.runner();
  const PlannedPose place = job.rest_pose();
  const auto here = machine_pose();
  if (const double by_mm = recovery_.finish_return(place, here ? std::optional(*here) : std::nullopt);
      by_mm != 0)
    job.shift_extruder(by_mm);
  position_.show_filament_less(job.extruder_shift_mm());
  heat_.finish_return();
  heat_hold_.forget();
  runner_ = &job;
  job.set_override(override_);
  job.go_on(now_);
  events_.message(now_, say("the job %1 goes on", print_.name()), place.line);
  enter(MachineState::kRunning);
}

}  // namespace kinebus
