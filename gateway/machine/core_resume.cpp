// Interrupted jobs: what is kept of them, and how they go on from exactly their place.

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;
using Done = Result<void, Refusal>;

/// The stream may begin so far from where an axis stands; its first segments take it back.
constexpr double kExactCounts = 3;
/// Nearer than this the tool goes back straight; farther away it comes from above, mm.
constexpr double kNear_mm = 0.5;
/// Farther than this the gateway does not go back by itself, mm.
constexpr double kByItself_mm = 0.1;
/// Filament that stands elsewhere by more than this was moved on purpose, mm.
constexpr double kFilament_mm = 0.5;
/// Back on the path from next to it, mm/s.
constexpr double kReturnSpeed = 5;
constexpr double kPrimeSpeed = 3;
constexpr BusTime kProgressPeriod = 250ms;
/// Path time stands there before a run is let go.
constexpr PathTime kBeforeStart = 3ms;

Error<Refusal> refuse(Sentence words) {
  return Error<Refusal>(Refusal{std::move(words)});
}

}  // namespace

Done Gateway::Core::recover(journal::State state, std::unique_ptr<ByteSource> job) {
  if (state_ != MachineState::kOff || print_.active())
    return refuse(say("too late: the machine is in use already"));
  live_lines_.restart(state.offsets_of(identity(machine_)));
  if (!state.job) return {};
  if (!job) return refuse(say("the interrupted job %1 is not there any more", state.job->name));
  job_name_ = state.job->name;
  if (state.override_ratio) override_ = std::clamp(*state.override_ratio, 0.01, 5.0);
  heat_wanted_ = state.thermal;
  if (state.thermal) heat_noted_ = *state.thermal;
  recovery_ = Recovery{std::move(state), std::move(job)};
  events_.message(now_, say("the job %1 was interrupted: resume to go on with it, or cancel", job_name_));
  return {};
}

void Gateway::Core::begin_job(const PoseVector& start) {
  runner_ = &print_;
  journal_.push(journal::JobBegin{job_name_, job_bytes_, job_hash_, start, job_offsets_});
  heat_wanted_.reset();
  heat_noted_ = {};
  filament_lost_ = false;
  print_.start_job(std::move(job_), start, job_offsets_);
  print_.set_override(override_);
  journal_.push(journal::Override{override_});
}

void Gateway::Core::give_up_job() {
  if (print_.active() || recovery_) journal_.push(journal::JobEnd{});
  recovery_.reset();
  if (print_.active()) thermal_.set_spindle(0);
  print_.drop();
  heat_wanted_.reset();
  job_name_.clear();
}

void Gateway::Core::interrupt(PathTime tau) {
  job_follows_ = returning_ = false;
  print_.suspend(tau);
}

/// Targets, and now and then the place, as the job goes on.
void Gateway::Core::note_progress() {
  if (!print_.active() || heat_wanted_) return;
  const journal::Thermal now{thermal_.heater(Heater::kHotend).target_celsius,
                             thermal_.heater(Heater::kBed).target_celsius, thermal_.fan(),
                             thermal_.spindle().target_rpm};
  if (!(now == heat_noted_)) journal_.push(heat_noted_ = now);
  if (now_ < progress_due_ || print_.suspended() || print_.between_runs() || rate_.rate(now_) == 0) return;
  progress_due_ = now_ + kProgressPeriod;
  journal_.push(journal::Progress{group_.confirmed(rate_.tau(now_)), print_.line(now_), joints_now()});
}

// Going on
// ---------------------------------------------------------------------------------------------------------

Done Gateway::Core::go_on() {
  going_on_ = true;
  Done done;
  if (state_ == MachineState::kOff)
    done = begin_bring_up();
  else if (state_ == MachineState::kUnhomed)
    begin_homing();
  else
    done = begin_return();
  if (!done) going_on_ = false;
  return done;
}

/// Once after the start, when the machine file says so.
void Gateway::Core::try_by_itself() {
  if (!recovery_ || asked_itself_) return;
  asked_itself_ = true;
  if (machine_.resume.after_restart != ResumeDescription::Then::kGoOn) return;
  by_itself_ = true;
  static_cast<void>(go_on());
}

/// A bring-up has read the nodes' path times and may change them: the journal must know them first.
void Gateway::Core::note_found() {
  if (!recovery_ || !recovery_->state.run || recovery_->state.found || bring_up_.found_path_times().empty())
    return;
  const journal::State& state = recovery_->state;
  const PathTime tau = found_tau(state.run->start, state.progress ? state.progress->tau : state.run->start);
  recovery_->state.found = tau;
  journal_.push(journal::Found{tau});
  found_noted_ = now_;
}

PathTime Gateway::Core::found_tau(PathTime start, PathTime otherwise) const {
  std::optional<PathTime> least;
  for (const PathTime tau : bring_up_.found_path_times())
    if (tau >= start - kBeforeStart && (!least || tau < *least)) least = tau;
  return least.value_or(otherwise);
}

/// After bring-up or homing, on the way to the job's place.
void Gateway::Core::finish_recovery() {
  const bool ask = by_itself_ && machine_.resume.after_power_loss == ResumeDescription::Then::kAsk;
  if (!homed_ && ask) {
    going_on_ = false;
    return events_.message(now_,
                           say("the nodes have lost their positions: resume homes the machine and goes on"));
  }
  if (!homed_) return begin_homing();
  const Done begun = begin_return();
  if (begun) return;
  going_on_ = false;
  events_.push({.kind = MachineEvent::Kind::kFinished,
                .when = now_,
                .words = say("the job does not go on: %1", begun.error().words),
                .advice = say("put right what is said, then resume")});
}

/// The job is checked once more, then read up to its place.
void Gateway::Core::step_recovery() {
  Recovery& recovery = *recovery_;
  if (recovery.replaying) {
    switch (print_.replay(options_.planning_budget)) {
      case Runner::Outcome::kBusy:
        return;
      case Runner::Outcome::kFailed:
        alarm(AlarmCode::kJobError, print_.failure().words, 0, print_.failure().line);
        give_up_job();
        return stop_all(false);
      default:
        break;
    }
    recovery_.reset();
    print_.set_override(override_);
    journal_.push(journal::Interrupted{print_.place({}), print_.extruder_shift_mm()});
    enter(MachineState::kReady);
    return finish_recovery();
  }
  if (!preflight_->step(options_.planning_budget)) return;
  job_report_ = preflight_->report();
  const bool good = preflight_->problems().errors() == 0;
  report_problems();
  preflight_.reset();
  const journal::State& state = recovery.state;
  if (!good || job_->hash() != state.job->hash || job_->bytes() != state.job->bytes || !job_->rewind()) {
    events_.push(
        {.kind = MachineEvent::Kind::kFinished,
         .when = now_,
         .words = say("the job %1 is not the text that was interrupted: it does not go on", job_name_),
         .advice = say("run it from its beginning")});
    job_.reset();
    give_up_job();
    going_on_ = false;
    return enter(MachineState::kReady);
  }
  recovery.replaying = true;
  print_.start_replay(std::move(job_), state,
                      state.found.value_or(state.run ? state.run->start : PathTime{}));
}

Gateway::Core::Distance Gateway::Core::distance_from(const JointVector& wanted,
                                                     const PlannedPose& place) const {
  // Which joints the filament moves shows where they go when it does.
  JointVector with_filament{};
  PoseVector pose = place.pose;
  pose[kE] += 1;
  static_cast<void>(kinematics_->inverse(place.frame, pose, with_filament));
  Distance distance;
  for (std::size_t i = 0; i < axes_.size(); ++i)
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
      const AxisScaling& scaling = axes_[i].axes[axis];
      if (scaling.joint < 0) continue;
      const auto joint = static_cast<std::size_t>(scaling.joint);
      const double counts =
          std::abs(to_counts(positions_[i][axis].position) - scaling.to_counts(wanted[joint]));
      double& worst =
          std::abs(with_filament[joint] - wanted[joint]) > 0.5 ? distance.filament : distance.others;
      worst = std::max(worst, counts);
    }
  return distance;
}

std::vector<canonical::Line> Gateway::Core::heating() const {
  using canonical::Thermal;
  std::vector<canonical::Line> commands;
  const auto add = [&](Thermal::What what, Heater heater, const HeaterDescription& description,
                       double celsius) {
    const HeaterStatus status = thermal_.heater(heater);
    if (!description.present || celsius <= 0) return;
    const bool hot = status.actual_celsius >= celsius - description.window_c;
    if (!hot || status.target_celsius != celsius)
      commands.push_back({0, Thermal{.what = what, .value = celsius, .wait = true}});
  };
  const journal::Thermal wanted = heat_wanted_.value_or(heat_noted_);
  add(Thermal::What::kBed, Heater::kBed, machine_.thermal.bed, wanted.bed_celsius);
  add(Thermal::What::kHotend, Heater::kHotend, machine_.thermal.hotend, wanted.hotend_celsius);
  if (wanted.spindle_rpm != 0 && wanted.spindle_rpm != thermal_.spindle().actual_rpm)
    commands.push_back({0, canonical::Spindle{wanted.spindle_rpm}});
  return commands;
}

/// From far away the tool goes up, over its place, and down; from next to it, straight.
void Gateway::Core::add_approach(std::vector<canonical::Line>& commands, const PoseVector& from,
                                 PoseVector target) const {
  constexpr auto kFrame = canonical::Frame::kMachine;
  const double away_mm = std::hypot(target[kX] - from[kX], target[kY] - from[kY], target[kZ] - from[kZ]);
  const bool turned = std::abs(target[kA] - from[kA]) > 0.01 || std::abs(target[kC] - from[kC]) > 0.01;
  const auto reachable = [&](const PoseVector& pose) {
    return static_cast<bool>(kinematics_->check(Frame::kMachine, pose));
  };
  if (away_mm > kNear_mm || turned) {
    const double e_mm = std::exchange(target[kE], from[kE]);
    PoseVector above = target;
    above[kZ] += machine_.resume.lift_mm;
    if (!reachable(above)) above = target;
    PoseVector up = from;
    up[kZ] = std::max(from[kZ], above[kZ]);
    if (up[kZ] > from[kZ] && reachable(up)) commands.push_back({0, canonical::Traverse{up, kFrame}});
    PoseVector over = above;
    over[kZ] = std::max(up[kZ], above[kZ]);
    if (reachable(over)) commands.push_back({0, canonical::Traverse{over, kFrame}});
    commands.push_back({0, canonical::Traverse{above, kFrame}});
    commands.push_back(
        {0, canonical::Feed{
                .target = target, .frame = kFrame, .feed_per_s = machine_.resume.approach_mm_per_s}});
    target[kE] = e_mm;
    if (target[kE] == from[kE]) return;
  }
  commands.push_back({0, canonical::Feed{.target = target, .frame = kFrame, .feed_per_s = kReturnSpeed}});
}

Done Gateway::Core::begin_return() {
  if (recovery_) {
    if (!recovery_->job->rewind()) return refuse(say("the interrupted job cannot be read"));
    job_ = std::make_unique<HashedSource>(std::move(recovery_->job));
    JobCheck::Options check_options;
    if (heat_wanted_ && heat_wanted_->hotend_celsius > 0)
      check_options.hotend_celsius = heat_wanted_->hotend_celsius;
    problems_reported_ = 0;
    preflight_ = std::make_unique<Preflight>(machine_, *kinematics_, *job_, kinematics_->bed_reference(),
                                             check_options, recovery_->state.job->offsets);
    enter(MachineState::kChecking);
    return {};
  }
  const PlannedPose place = print_.rest_pose();
  JointVector wanted{};
  if (const auto found = kinematics_->inverse(place.frame, place.pose, wanted); !found)
    return refuse(say("the job's place cannot be reached: %1", to_string(found.error())));
  const auto from = machine_pose();
  if (!from) return Error<Refusal>(from.error());
  const auto machine_place = convert_pose(*kinematics_, place.frame, place.pose, Frame::kMachine);
  if (!machine_place)
    return refuse(say("the job's place cannot be reached: %1", to_string(machine_place.error())));

  PoseVector target = *machine_place;
  const Distance distance = distance_from(wanted, place);
  const bool filament_elsewhere = filament_lost_ || std::abs(target[kE] - (*from)[kE]) > kFilament_mm;
  if (filament_elsewhere) target[kE] = (*from)[kE];
  const double away_mm =
      std::hypot(target[kX] - (*from)[kX], target[kY] - (*from)[kY], target[kZ] - (*from)[kZ]);
  if (by_itself_ && homed_ && away_mm > kByItself_mm && !filament_lost_)
    return refuse(
        say("the tool was found %1 mm from its place: resume brings it back", printed("%.3f", away_mm)));

  std::vector<canonical::Line> commands = heating();
  const bool exact =
      distance.others <= kExactCounts && (filament_elsewhere || distance.filament <= kExactCounts);
  if (!exact) add_approach(commands, *from, target);
  if (filament_lost_ && machine_.resume.prime_mm > 0) {
    target[kE] += machine_.resume.prime_mm;
    commands.push_back(
        {0,
         canonical::Feed{.target = target, .frame = canonical::Frame::kMachine, .feed_per_s = kPrimeSpeed}});
  }
  thermal_.set_fan(heat_wanted_.value_or(heat_noted_).fan);
  if (commands.empty()) {
    finish_return();
    return {};
  }
  runner_ = &hand_;
  hand_.start_commands(std::move(commands), *from);
  hand_.set_override(1);
  returning_ = true;
  enter(MachineState::kRunning);
  return {};
}

/// The tool stands where the job goes on.
void Gateway::Core::finish_return() {
  going_on_ = false;
  const PlannedPose place = print_.rest_pose();
  if (const auto here = machine_pose()) {
    const double elsewhere_mm = (*here)[kE] - place.pose[kE];
    if (filament_lost_ || std::abs(elsewhere_mm) > kFilament_mm) print_.shift_extruder(elsewhere_mm);
  }
  filament_lost_ = false;
  if (const auto heat = std::exchange(heat_wanted_, std::nullopt)) {
    if (heat->hotend_celsius <= 0) thermal_.set_target(Heater::kHotend, 0);
    if (heat->bed_celsius <= 0) thermal_.set_target(Heater::kBed, 0);
  }
  runner_ = &print_;
  print_.set_override(override_);
  print_.go_on(now_);
  events_.message(now_, say("the job %1 goes on", job_name_), place.line);
  enter(MachineState::kRunning);
}

}  // namespace kinebus
