#include "gateway/run/runner.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/jobs/print_trace.hpp"
#include "gateway/run/thread_control.hpp"

namespace kinebus {
namespace {

/// The rate is raised at most so often, and lowered when it has to be: the bus is not filled with rate
/// commands.
constexpr BusTime kRaisePeriod = std::chrono::milliseconds{250};
constexpr double kRateStep = 0.02;
/// Where feed goes by the spindle's speed.
constexpr double kSpindleStep = 0.004;
constexpr BusTime kSpindlePeriod = std::chrono::milliseconds{30};

/// planned_pose() knows so much of the past.
constexpr PathTime kPlannedMemory = std::chrono::seconds{1};
/// A run waits at most so long for the journal to have its beginning on the disk.
constexpr BusTime kJournalPatience = std::chrono::milliseconds{500};

}  // namespace

Runner::Runner(const MachineDescription& machine, const Kinematics& kinematics, StreamGroup& group,
               PathRate& rate, Heat& heat, EventQueue& events, journal::Queue& journal,
               bodies::PrintedPart* printed)
    : machine_(machine),
      kinematics_(kinematics),
      group_(group),
      rate_(rate),
      heat_(heat),
      events_out_(events),
      journal_(journal),
      printed_(printed),
      pipeline_(machine, kinematics),
      feed_(group),
      smooth_ramp_(machine, kinematics) {}

void Runner::begin() {
  active_ = true;
  held_ = still_ = suspended_ = started_ = finished_ = stop_asked_ = barrier_waits_ = live_ = false;
  probing_ = probe_cut_ = false;
  probe_wrong_.reset();
  follower_.follow(0);
  per_turn_.follow(0);
  hold_waits_ = thread_over_ = false;
  has_melted_ = {};
  molten_mm_ = start_[kE];
  thread_lost_.reset();
  answers_.clear();
  check_.reset();
  wait_ = Wait::kNone;
  waits_done_ = waits_replayed_ = 0;
  events_.clear();
  feed_.reset();
  last_line_ = 0;
  doing_ = say("moving");
}

void Runner::start_job(std::unique_ptr<ByteSource> source, const Pose& start,
                       const gcode::WorkOffsets& offsets) {
  if (printed_ != nullptr) printed_->clear();
  source_ = std::move(source);
  pipeline_.start_job(*source_, start, offsets);
  start_ = start;
  noted_ = true;
  begin();
}

void Runner::start_commands(std::vector<canonical::Line> commands, const Pose& start) {
  pipeline_.start_commands(std::move(commands), start);
  start_ = start;
  noted_ = false;
  begin();
}

void Runner::set_override(double ratio) {
  override_ = ratio;
  const double scale = std::max(1.0, ratio);
  if (scale == pipeline_.feed_scale()) return;
  pipeline_.set_feed_scale(scale);
  if (noted_ && active_) journal_.push(journal::Scale{{pipeline_.moves_taken(), scale}});
}

void Runner::hold(BusTime now) {
  if (cuts_thread())
    hold_waits_ = true;
  else
    hold_at_once(now);
}

void Runner::hold_at_once(BusTime now) {
  held_ = true;
  if (feed_.streaming())
    change_rate(0, now);
  else
    rate_.request(0, kRampAtRest, now);
}

void Runner::change_rate(double rate, BusTime now) {
  if (!rate_.smooth()) return rate_.request(rate, machine_.stop.hold_ramp, now);
  if (rate_.is_target(rate)) return;
  // In the mean no steeper than a straight one.
  const double change = std::abs(rate - rate_.rate(now));
  const auto least = std::chrono::milliseconds{
      std::llround(change / 2 * static_cast<double>(machine_.stop.hold_ramp.count()))};
  const auto ramp = smooth_ramp_.full_ramp(
      [this](PathTime tau) { return planned_pose(tau); },
      [&](std::chrono::milliseconds full_ramp) { return rate_.with_smooth(rate, full_ramp, now); }, least,
      rate_.tau(now), now);
  rate_.request_smooth(rate, ramp, now);
}

void Runner::resume(BusTime now) {
  held_ = still_ = hold_waits_ = false;
  if (wait_ == Wait::kPause) end_wait();
  look_at_input_anew();
  last_time_ = now;  // what a hold has taken is no time of a wait
  last_rate_change_ = now - kRaisePeriod;
}

void Runner::drop() {
  give_up_probe();
  active_ = suspended_ = probe_cut_ = false;
  feed_.reset();
  events_.clear();
  source_.reset();
  doing_ = {};
}

double Runner::done_s(BusTime now) const {
  return feed_.done_s(rate_.tau(now));
}

std::optional<PlannedPose> Runner::planned_pose(PathTime tau) const {
  PlannedPose planned;
  const auto point = feed_.pose(tau, planned.frame, planned.line);
  if (!point) return std::nullopt;
  planned.pose = point->x;
  return planned;
}

FlowAhead Runner::filament_ahead(BusTime now) const {
  FlowAhead flow{};
  const double rate = rate_.target();
  if (!active_ || suspended_ || held_ || !started_ || !feed_.streaming() || !(rate > 0)) return flow;
  const PathTime tau = rate_.tau(now);
  const double step_s = to_seconds(kFlowAheadStep);
  const auto filament_at = [&](std::size_t steps) -> std::optional<double> {
    const auto ahead = PathTime{std::llround(static_cast<double>(steps) * step_s * rate * 16e6)};
    const auto planned = planned_pose(tau + ahead);
    return planned ? std::optional(planned->pose[kE]) : std::nullopt;
  };
  auto from = filament_at(0);
  for (std::size_t i = 0; from && i < flow.size(); ++i) {
    const auto to = filament_at(i + 1);
    if (to)
      flow[i] = (*to - *from) / step_s;
    else if (!finished_ && i > 0)
      flow[i] = flow[i - 1];  // not planned yet
    else
      break;
    if (to) from = to;
  }
  return flow;
}

std::uint32_t Runner::line(BusTime now) const {
  // What is planned behind the place does not count.
  if (suspended_) return rest_pose().line;
  const std::uint32_t line = feed_.streaming() ? group_.line_at(rate_.tau(now)) : 0;
  return line != 0 ? line : last_line_;
}

Runner::Outcome Runner::fail(std::uint32_t line, Sentence words, bool stream) {
  failure_ = {line, std::move(words), stream};
  give_up_probe();
  return Outcome::kFailed;
}

Runner::Outcome Runner::on_time(BusTime now, int budget) {
  if (!active_) return Outcome::kDone;
  const BusTime elapsed = std::max(BusTime{0}, now - last_time_);
  last_time_ = now;
  plans_on_ = false;
  if (suspended_) return Outcome::kBusy;
  if ((wait_ == Wait::kDwell || wait_ == Wait::kInput) && !held_)
    dwell_left_ -= std::min(dwell_left_, elapsed);
  execute_due(now);
  if (stop_asked_) return Outcome::kEmergencyStop;
  feed_.forget_before(group_.confirmed(rate_.tau(now)) - kPlannedMemory);
  look_at_probe(now);
  if (probe_wrong_) return fail(last_line_, *std::exchange(probe_wrong_, std::nullopt), false);
  if (thread_lost_) return fail(last_line_, *std::exchange(thread_lost_, std::nullopt), false);
  if (probe_cut_) return probe_outcome(now);
  Outcome outcome = Outcome::kBusy;
  if (!still_ && std::exchange(barrier_waits_, false)) outcome = barrier(now);
  if (outcome == Outcome::kBusy) outcome = stream(now);
  while (outcome == Outcome::kBusy && budget > 0) {
    if (feed_.pending() || barrier_waits_) break;
    if (wait_ != Wait::kNone && !wait_is_over(now)) break;
    if (stop_asked_) return Outcome::kEmergencyStop;
    if (!finished_ && !feed_.wants_phase(rate_.tau(now))) break;
    const JobPipeline::Step step = pipeline_.next(budget);
    plans_on_ = step == JobPipeline::Step::kMore;
    if (plans_on_) break;
    if (step == JobPipeline::Step::kStarved) {
      settle_when_late(now);
      break;
    }
    outcome = take(now, step);
  }
  if (outcome == Outcome::kBusy) follower_.follows() ? follow_spindle(now) : control_rate(now);
  if (outcome == Outcome::kBusy && wait_ == Wait::kPause) return Outcome::kPaused;
  return outcome;
}

/// What was planned goes into the group as far as it wants.
Runner::Outcome Runner::stream(BusTime now) {
  const auto pumped = feed_.pump(rate_.tau(now));
  if (const auto run = feed_.take_begun()) {
    started_ = false;
    run_noted_ = now;
    if (noted_)
      journal_.push(journal::RunBegin{run->start, run->from, run->ramp_s, feed_.extruder_shift_mm()});
  }
  return pumped ? Outcome::kBusy : fail(pumped.error().line, to_string(pumped.error()), true);
}

void Runner::take_phase() {
  const Phase& phase = pipeline_.phase();
  finished_ = phase.last;
  last_line_ = phase.line;
  feed_.add(phase);
  if (printed_ != nullptr) trace_print(phase, phase.piece.evaluate(phase.s(phase.duration_s)), *printed_);
}

Runner::Outcome Runner::take(BusTime now, JobPipeline::Step step) {
  using Step = JobPipeline::Step;
  if (check_)
    if (auto wrong = wrong_after_probe(step)) return fail(wrong->line, std::move(wrong->words), false);
  switch (step) {
    case Step::kPhase:
      take_phase();
      return stream(now);
    case Step::kEvent:
      events_.push_back({feed_.added(), pipeline_.command()});
      execute_due(now);
      return stop_asked_ ? Outcome::kEmergencyStop : Outcome::kBusy;
    case Step::kRunEnd:
      finished_ = false;
      thread_over_ = true;
      if (feed_.streaming()) wait_ = Wait::kRunDone;
      return Outcome::kBusy;
    case Step::kBarrier:
      barrier_waits_ = still_;
      return still_ ? Outcome::kBusy : barrier(now);
    case Step::kMelt:
      if (!heat_.too_cold()) return Outcome::kBusy;
      wait_ = Wait::kMelt;
      doing_ = say("waiting for the %1 at %2", heater_words(heat_.tool()),
                   printed("%.0f C", machine_.thermal.min_extrude_c));
      return Outcome::kBusy;
    case Step::kProbed:
      if (ContactProbe* const probe = heat_.probe()) probe->ask();
      wait_ = Wait::kProbeEnd;
      return Outcome::kBusy;
    case Step::kEnd:
      return Outcome::kDone;
    case Step::kProblem:
      return fail(pipeline_.problem().line, pipeline_.problem().words, false);
    case Step::kMore:
    case Step::kStarved:
      break;
  }
  return Outcome::kBusy;
}

/// Another gateway must find in the journal what path time means from here on.
bool Runner::waits_for_journal(BusTime now) const {
  return noted_ && !journal_.all_stored() && now - run_noted_ < kJournalPatience;
}

/// By override and spindle.
double Runner::wanted_rate(BusTime now) {
  if (!per_turn_.follows()) return std::min(override_, 1.0);
  per_turn_.look(heat_.spindle_angle());
  const auto measured = per_turn_.ratio_if_known(now + ThreadControl::kAhead);
  return std::clamp(override_ * measured.value_or(1), 0.0, 1.0);
}

/// Path time runs while a run's records are in the nodes in time, and no faster than bus and override allow.
void Runner::control_rate(BusTime now) {
  const double asked = wanted_rate(now);
  if (!feed_.streaming() || held_ || rate_.stop_latched()) return;
  const PathTime tau = rate_.tau(now);
  if (!started_) {
    if (!group_.primed(tau)) return;
    if (waits_for_journal(now)) return;
    started_ = true;
    last_rate_change_ = now;
    const double allowed = group_.allowed_rate(tau);
    if (allowed < std::min(override_, 1.0)) ++counters_.bus_slowdowns;
    rate_.request(std::min(per_turn_.follows() ? asked : override_, allowed), kRampAtRest, now);
    return;
  }
  const double allowed = group_.allowed_rate(tau);
  const double wanted = std::min(asked, allowed);
  const double present = rate_.target();
  // A spindle changes its speed more often than an operator his mind.
  const bool spindle = per_turn_.follows() && allowed >= present;
  const double step = spindle ? kSpindleStep : kRateStep;
  const bool due = now - last_rate_change_ >= (spindle ? kSpindlePeriod : kRaisePeriod);
  const bool lower = (due || !spindle) && (wanted < present - step || (wanted <= 0 && present > 0));
  const bool raise = due && wanted > present + (spindle ? kSpindleStep : 0);
  if (!lower && !raise) return;
  if (lower && allowed < override_) {
    if (allowed > 0)
      ++counters_.bus_slowdowns;
    else
      ++counters_.starvation_holds;
  }
  // After starvation the queues fill up first.
  if (raise && present <= 0 && !group_.primed(tau)) return;
  last_rate_change_ = now;
  // A queue that runs empty is not waited for.
  if (lower && allowed < override_) return rate_.request(wanted, machine_.stop.hold_ramp, now);
  change_rate(wanted, now);
}

}  // namespace kinebus
