#include "gateway/machine/runner.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <utility>

namespace kinebus {
namespace {

/// At rest no joint feels a ramp: path time is let go and caught at once.
constexpr std::chrono::milliseconds kRampAtRest{2};
/// From the naming of a run's START to path time: knots lie on a 16 us grid, and START must lie ahead of tau.
constexpr PathTime kStartLead = std::chrono::milliseconds{1};
/// The rate is raised at most so often, and lowered when it has to be: the bus is not filled with rate
/// commands.
constexpr BusTime kRaisePeriod = std::chrono::milliseconds{250};
constexpr double kRateStep = 0.02;

/// Live commands: a run under way is brought to a planned stop when less than this is left to move, so that
/// the stop is in the nodes long before their reserve (120 ms) begins.
constexpr double kLiveReserve_s = 0.6;
/// At rest the first commands wait so long for more, so that a stream of short moves begins as one.
constexpr BusTime kLiveGather = std::chrono::milliseconds{100};

/// planned_pose() knows so much of the past.
constexpr PathTime kPlannedMemory = std::chrono::seconds{1};

PathTime after(PathTime start, double seconds) {
  return start + PathTime{static_cast<std::int64_t>(seconds * 16e6)};
}

std::string celsius_words(const char* what, double celsius) {
  char text[64];
  std::snprintf(text, sizeof text, "waiting for %s at %.0f C", what, celsius);
  return text;
}

}  // namespace

Runner::Runner(const MachineDescription& machine, const Kinematics& kinematics, StreamGroup& group,
               PathRate& rate, ThermalDevice& thermal, EventQueue& events)
    : machine_(machine),
      group_(group),
      rate_(rate),
      thermal_(thermal),
      events_out_(events),
      pipeline_(machine, kinematics) {}

void Runner::begin() {
  active_ = true;
  held_ = streaming_ = started_ = finished_ = stop_asked_ = live_ = false;
  wait_ = Wait::kNone;
  events_.clear();
  planned_.clear();
  finished_runs_s_ = 0;
  last_line_ = 0;
  doing_ = "moving";
}

void Runner::start_job(std::unique_ptr<ByteSource> source, const PoseVector& start) {
  source_ = std::move(source);
  pipeline_.start_job(*source_, start);
  begin();
}

void Runner::start_commands(std::vector<canonical::Line> commands, const PoseVector& start) {
  pipeline_.start_commands(std::move(commands), start);
  begin();
}

void Runner::start_live(const PoseVector& start) {
  pipeline_.start_live(start);
  begin();
  live_ = true;
  doing_ = "waiting for lines";
}

void Runner::add(BusTime now, const canonical::Line& line) {
  pipeline_.add(line);
  last_added_ = now;
}

/// The pipeline has nothing more to give out before the next live command comes.
void Runner::settle_when_late(BusTime now) {
  if (!streaming_) {
    if (pipeline_.live_idle()) doing_ = "waiting for lines";
    if (now - last_added_ >= kLiveGather) pipeline_.settle_live();
    return;
  }
  const double left = group_.sampler().end_s() - to_seconds(rate_.tau(now) - group_.run_start());
  if (finished_ || left >= kLiveReserve_s) return;
  pipeline_.settle_live();
  ++counters_.live_stops;
}

void Runner::set_override(double ratio) {
  override_ = ratio;
  pipeline_.set_feed_scale(std::max(1.0, ratio));
}

void Runner::hold(BusTime now) {
  held_ = true;
  rate_.request(0, streaming_ ? machine_.stop.hold_ramp : kRampAtRest, now);
}

void Runner::resume(BusTime now) {
  held_ = false;
  if (wait_ == Wait::kPause) wait_ = Wait::kNone;
  last_rate_change_ = now - kRaisePeriod;
}

void Runner::drop() {
  active_ = streaming_ = false;
  events_.clear();
  source_.reset();
  doing_.clear();
}

double Runner::done_s(BusTime now) const {
  if (!streaming_) return finished_runs_s_;
  return finished_runs_s_ + std::max(0.0, to_seconds(rate_.tau(now) - group_.run_start()));
}

PathTime Runner::end_of(const PlannedPhase& p) {
  return after(p.start, p.start_s + p.phase.duration_s);
}

std::optional<PlannedPose> Runner::planned_pose(PathTime tau) const {
  const auto found =
      std::upper_bound(planned_.begin(), planned_.end(), tau,
                       [](PathTime t, const PlannedPhase& p) { return t < after(p.start, p.start_s); });
  if (found == planned_.begin()) return std::nullopt;
  const PlannedPhase& p = *std::prev(found);
  const double t = to_seconds(tau - p.start) - p.start_s;
  if (t > p.phase.duration_s + 1e-6) return std::nullopt;
  return PlannedPose{p.phase.at(std::clamp(t, 0.0, p.phase.duration_s)).x, p.phase.piece.frame, p.phase.line};
}

std::uint32_t Runner::line(BusTime now) const {
  const std::uint32_t line = streaming_ ? group_.line_at(rate_.tau(now)) : 0;
  return line != 0 ? line : last_line_;
}

Runner::Outcome Runner::fail(std::uint32_t line, std::string words, bool stream) {
  failure_ = {line, std::move(words), stream};
  return Outcome::kFailed;
}

Runner::Outcome Runner::on_time(BusTime now, int budget) {
  if (!active_) return Outcome::kDone;
  const BusTime elapsed = std::max(BusTime{0}, now - last_time_);
  last_time_ = now;
  if (wait_ == Wait::kDwell && !held_) dwell_left_ -= std::min(dwell_left_, elapsed);
  execute_due(now);
  if (stop_asked_) return Outcome::kEmergencyStop;
  const PathTime forgotten = rate_.tau(now) - kPlannedMemory;
  while (!planned_.empty() && end_of(planned_.front()) < forgotten) planned_.pop_front();
  Outcome outcome = Outcome::kBusy;
  while (outcome == Outcome::kBusy && budget > 0) {
    if (wait_ != Wait::kNone && !wait_is_over(now)) break;
    if (streaming_ && !finished_ && !group_.wants_phases(rate_.tau(now))) break;
    const JobPipeline::Step step = pipeline_.next(budget);
    if (step == JobPipeline::Step::kMore) break;
    if (step == JobPipeline::Step::kStarved) {
      settle_when_late(now);
      break;
    }
    outcome = take(now, step);
  }
  if (outcome == Outcome::kBusy) control_rate(now);
  if (outcome == Outcome::kBusy && wait_ == Wait::kPause) return Outcome::kPaused;
  return outcome;
}

bool Runner::wait_is_over(BusTime now) {
  switch (wait_) {
    case Wait::kNone:
      return true;
    case Wait::kRunDone:
      if (!group_.run_done(rate_.tau(now))) return false;
      finished_runs_s_ += pipeline_.run_s();
      streaming_ = false;
      rate_.request(0, kRampAtRest, now);
      wait_ = Wait::kRest;
      return wait_is_over(now);
    case Wait::kRest:
      if (!rate_.at_rest(now)) return false;
      break;
    case Wait::kDwell:
      if (dwell_left_ > BusTime{0}) return false;
      break;
    case Wait::kHeating: {
      if (held_) return false;
      if (!heating_.over(thermal_)) {
        in_window_since_.reset();
        return false;
      }
      if (!in_window_since_) in_window_since_ = now;
      const auto& heater =
          heating_.heater == Heater::kHotend ? machine_.thermal.hotend : machine_.thermal.bed;
      if (now - *in_window_since_ < heater.settle) return false;
      break;
    }
    case Wait::kPause:
      return false;
  }
  wait_ = Wait::kNone;
  doing_ = "moving";
  return true;
}

void Runner::execute_due(BusTime now) {
  const PathTime tau = rate_.tau(now);
  while (!events_.empty() && (!streaming_ || events_.front().due <= tau)) {
    execute(now, events_.front().line);
    events_.pop_front();
  }
}

void Runner::execute(BusTime now, const canonical::Line& line) {
  using What = canonical::Thermal::What;
  if (const auto* thermal = std::get_if<canonical::Thermal>(&line.command)) {
    if (thermal->what == What::kFan)
      thermal_.set_fan(thermal->value);
    else
      thermal_.set_target(thermal->what == What::kHotend ? Heater::kHotend : Heater::kBed, thermal->value);
  } else if (const auto* message = std::get_if<canonical::Message>(&line.command)) {
    events_out_.message(now, message->text, line.line);
  } else if (std::holds_alternative<canonical::EmergencyStop>(line.command)) {
    stop_asked_ = true;
  }
}

Runner::Outcome Runner::take(BusTime now, JobPipeline::Step step) {
  using Step = JobPipeline::Step;
  switch (step) {
    case Step::kPhase: {
      const bool first = !streaming_;
      if (first) {
        group_.begin_run();
        streaming_ = true;
        started_ = false;
      }
      finished_ = pipeline_.phase().last;
      last_line_ = pipeline_.phase().line;
      if (const auto pushed = group_.push(pipeline_.phase()); !pushed)
        return fail(pushed.error().line, to_string(pushed.error()), true);
      if (first) group_.release(rate_.tau(now) + kStartLead);
      planned_.push_back(
          {group_.run_start(), pipeline_.run_s() - pipeline_.phase().duration_s, pipeline_.phase()});
      return Outcome::kBusy;
    }
    case Step::kEvent: {
      const auto offset = static_cast<std::int64_t>(pipeline_.event_s() * 16e6);
      events_.push_back(
          {streaming_ ? group_.run_start() + PathTime{offset} : PathTime{0}, pipeline_.command()});
      execute_due(now);
      return stop_asked_ ? Outcome::kEmergencyStop : Outcome::kBusy;
    }
    case Step::kRunEnd:
      wait_ = Wait::kRunDone;
      return Outcome::kBusy;
    case Step::kBarrier:
      return barrier(now);
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

Runner::Outcome Runner::barrier(BusTime now) {
  const canonical::Line& line = pipeline_.command();
  last_line_ = line.line;
  if (const auto* dwell = std::get_if<canonical::Dwell>(&line.command)) {
    dwell_left_ = BusTime{static_cast<std::int64_t>(dwell->seconds * 1e9)};
    wait_ = Wait::kDwell;
    doing_ = "dwelling";
  } else if (const auto* thermal = std::get_if<canonical::Thermal>(&line.command)) {
    execute(now, line);
    begin_heating(*thermal);
  } else if (std::holds_alternative<canonical::Pause>(line.command)) {
    wait_ = Wait::kPause;
    doing_ = "paused by the job";
    events_out_.message(now, "the job pauses here: resume to go on", line.line);
  } else if (std::holds_alternative<canonical::MotorsOff>(line.command)) {
    // A platform on vertical rails falls when its drives let go: drives hold, with hold current, until the
    // operator switches them off.
    events_out_.message(now, "M18/M84 in a job: the motors go on holding", line.line);
  }
  return Outcome::kBusy;
}

void Runner::begin_heating(const canonical::Thermal& thermal) {
  const bool hotend = thermal.what == canonical::Thermal::What::kHotend;
  const HeaterDescription& heater = hotend ? machine_.thermal.hotend : machine_.thermal.bed;
  if (thermal.value <= 0 && !thermal.wait_cooling) return;
  heating_ = {hotend ? Heater::kHotend : Heater::kBed, thermal.value, heater.window_c, thermal.wait_cooling};
  in_window_since_.reset();
  wait_ = Wait::kHeating;
  doing_ = celsius_words(hotend ? "the hotend" : "the bed", thermal.value);
}

/// Path time runs while a run's records are in the nodes in time, and no faster than bus and override allow.
void Runner::control_rate(BusTime now) {
  if (!streaming_ || held_ || rate_.stop_latched()) return;
  const PathTime tau = rate_.tau(now);
  if (!started_) {
    if (!group_.primed(tau)) return;
    started_ = true;
    last_rate_change_ = now;
    const double allowed = group_.allowed_rate(tau);
    if (allowed < std::min(override_, 1.0)) ++counters_.bus_slowdowns;
    rate_.request(std::min(override_, allowed), kRampAtRest, now);
    return;
  }
  const double allowed = group_.allowed_rate(tau);
  const double wanted = std::min({override_, allowed, 1.0});
  const double present = rate_.target();
  const bool lower = wanted < present - kRateStep || (wanted <= 0 && present > 0);
  const bool raise = wanted > present && now - last_rate_change_ >= kRaisePeriod;
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
  rate_.request(wanted, machine_.stop.hold_ramp, now);
}

}  // namespace kinebus
