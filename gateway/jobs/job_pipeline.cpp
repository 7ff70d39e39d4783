#include "gateway/jobs/job_pipeline.hpp"

#include <algorithm>
#include <utility>

#include "gateway/jobs/live_lines.hpp"
#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {
namespace {

using namespace canonical;

constexpr std::size_t kTextBytes = 16'384;
constexpr double kNoFilament_mm = 1e-9;

template <typename... Ts>
bool is_any(const Command& command) {
  return (std::holds_alternative<Ts>(command) || ...);
}

/// For which motion must have come to rest.
bool is_barrier(const Command& command, bool optional_stop) {
  if (const auto* thermal = std::get_if<Thermal>(&command)) return thermal->wait;
  if (const auto* pause = std::get_if<Pause>(&command)) return !pause->optional || optional_stop;
  return is_any<Dwell, Home, MotorsOff, MotorsOn, WaitIdle, canonical::Spindle, canonical::Probe,
                canonical::Mesh, ProbePin, AwaitInput, SpindleSync, Tool>(command);
}

/// Target of a motion command.
std::optional<SetPosition> target_of(const Command& command) {
  if (const auto* m = std::get_if<Traverse>(&command)) return SetPosition{m->target, m->frame};
  if (const auto* m = std::get_if<Feed>(&command)) return SetPosition{m->target, m->frame};
  if (const auto* m = std::get_if<Arc>(&command)) return SetPosition{m->target, m->frame};
  if (const auto* m = std::get_if<SetPosition>(&command)) return *m;
  return std::nullopt;
}

}  // namespace

JobPipeline::JobPipeline(const MachineDescription& machine, const Kinematics& kinematics)
    : machine_(machine),
      kinematics_(kinematics),
      planner_(kinematics, limits_before_shaping(machine, machine.vibration)),
      shaper_(axis_shapers(machine.vibration)),
      shaped_limits_(kinematics, motion_limits(machine).joint_speed_per_s,
                     motion_limits(machine).joint_accel_per_s2),
      vibration_(machine.vibration),
      text_(kTextBytes) {}

void JobPipeline::begin(const Pose& start) {
  if (!(vibration_ == machine_.vibration)) {
    vibration_ = machine_.vibration;
    planner_.limit_machine(limits_before_shaping(machine_, vibration_));
  }
  asked_shaping_ = {};
  thread_ = {};
  planner_.reset(start, Frame::kMachine);
  advance_ = machine_.pressure_advance;
  shaper_ = {};
  begin_advance();
  over_limit_ = false;
  commands_.clear();
  next_command_ = 0;
  first_.clear();
  events_.clear();
  path_mode_.reset();
  limits_ = {};
  stage_ = Stage::kFeeding;
  in_run_ = ends_ = phase_waits_ = probing_ = melt_due_ = false;
  melt_.begin(machine_);
  barrier_.reset();
  refused_.reset();
  run_s_ = event_s_ = 0;
  lines_ = 0, bytes_ = 0;
  text_at_ = text_end_ = 0;
  feed_scale_ = 1, moves_taken_ = 0;
  scales_.clear(), left_out_.clear(), places_.clear();
  touched_.clear();
}

void JobPipeline::start_job(ByteSource& source, const Pose& start, const gcode::WorkOffsets& offsets) {
  begin(start);
  const Pose home = kinematics_.bed_reference();
  gcode::Options options = interpreter_options(machine_, start, home);
  options.work_offsets = offsets;
  interpreter_ = std::make_unique<gcode::Interpreter>(std::move(options));
  reader_ = std::make_unique<gcode::JobReader>(*interpreter_, 1);
  source_ = &source;
  text_done_ = false;
}

void JobPipeline::start_commands(std::vector<canonical::Line> commands, const Pose& start) {
  begin(start);
  melt_.look_away();  // who moves by hand is told at once
  commands_ = std::move(commands);
  source_ = nullptr;
  text_done_ = true;
}

void JobPipeline::start_live(const Pose& start) {
  begin(start);
  source_ = nullptr;
  text_done_ = false;
}

void JobPipeline::add(const canonical::Line& line) {
  constexpr std::size_t kUsedAtMost = 256;
  if (next_command_ == commands_.size() || next_command_ >= kUsedAtMost) {
    commands_.erase(commands_.begin(), commands_.begin() + static_cast<std::ptrdiff_t>(next_command_));
    next_command_ = 0;
  }
  commands_.push_back(line);
}

bool JobPipeline::live_idle() const {
  return waiting() == 0 && first_.empty() && events_.empty() && !in_run_ && !phase_waits_ && !barrier_ &&
         !refused_ && stage_ == Stage::kFeeding && planner_.idle();
}

void JobPipeline::settle_live() {
  if (stage_ == Stage::kFeeding && waiting() == 0 && !live_idle()) drain(std::nullopt);
}

void JobPipeline::plan_live() {
  while (stage_ == Stage::kFeeding && !refused_ && planner_.wants_more() && take_known()) {
  }
}

Planner::Ahead JobPipeline::ahead() {
  Planner::Ahead ahead = planner_.ahead();
  ahead.final_s += shaper_.held_s();
  ahead.all_s += shaper_.held_s();
  if (phase_waits_) {
    ahead.final_s += phase_.duration_s;
    ahead.all_s += phase_.duration_s;
  }
  return ahead;
}

/// The next command that needs no reading; false: there is none.
bool JobPipeline::take_known() {
  if (!first_.empty()) {
    const canonical::Line line = std::move(first_.front());
    first_.pop_front();
    take(line);
    return true;
  }
  if (next_command_ == commands_.size()) return false;
  take(commands_[next_command_++]);
  return true;
}

void JobPipeline::refuse(std::uint32_t line, std::uint32_t column, Sentence words) {
  refused_ = Problem{Problem::Severity::kError, line, column, std::move(words)};
}

JobPipeline::Step JobPipeline::next(int& budget) {
  for (;;) {
    if (refused_) {
      problem_ = std::move(*refused_);
      refused_.reset();
      return Step::kProblem;
    }
    if (phase_waits_ || stage_ == Stage::kDraining || (stage_ == Stage::kFeeding && !planner_.wants_more())) {
      if (const auto step = take_phase()) return *step;
      if (stage_ == Stage::kDraining) stage_ = Stage::kSettled;
    }
    if (stage_ == Stage::kSettled) {
      if (const auto step = settle()) return *step;
      continue;
    }
    if (stage_ == Stage::kEnded) return Step::kEnd;
    if (stage_ == Stage::kProbed) return Step::kProbed;
    if (stage_ == Stage::kProbes) {
      plan_probe();
      continue;
    }
    if (take_known()) continue;
    if (text_done_) {
      ends_ = true;
      drain(std::nullopt);
    } else if (source_ == nullptr) {
      planner_.plan_known();
      const auto step = take_phase();
      return step ? *step : Step::kStarved;
    } else {
      if (budget <= 0) return Step::kMore;
      read_text(budget);
    }
  }
}

/// The planner's next phase, shaped where the machine shapes.
bool JobPipeline::pull_phase() {
  if (!shaping_) {
    phase_.timed = false;  // a run before this one may have been shaped
    if (!planner_.next(phase_)) return false;
    if (thread_.sync.rpm > 0) watch_thread(phase_);
    phase_.piece.coefficients[kE][0] += shaper_.filament_offset_mm();
    return true;
  }
  while (!shaper_.next(phase_))
    if (!push_planned()) return false;
  check_shaped();
  return true;
}

/// The next phase, or an event that falls due before it.
std::optional<JobPipeline::Step> JobPipeline::take_phase() {
  if (!phase_waits_) phase_waits_ = pull_phase();
  if (!phase_waits_) return std::nullopt;
  if (!in_run_) run_s_ = 0;
  in_run_ = true;
  if (!events_.empty() && events_.front().line < phase_.line) {
    command_ = std::move(events_.front());
    events_.pop_front();
    command_.line = line_of(command_.line);
    event_s_ = run_s_;
    return Step::kEvent;
  }
  phase_waits_ = false;
  // What waits in events_ comes after this phase: the places before it are done with.
  while (places_.size() > 1 && places_[1].place <= phase_.line) places_.pop_front();
  phase_.line = line_of(phase_.line);
  run_s_ += phase_.duration_s;
  return Step::kPhase;
}

/// After the last phase: the events left, the run's end, the barrier, the job's end.
std::optional<JobPipeline::Step> JobPipeline::settle() {
  if (!events_.empty()) {
    command_ = std::move(events_.front());
    events_.pop_front();
    command_.line = line_of(command_.line);
    event_s_ = in_run_ ? run_s_ : 0;
    return Step::kEvent;
  }
  if (in_run_) {
    in_run_ = false;
    check_thread();
    return Step::kRunEnd;
  }
  if (std::exchange(melt_due_, false)) {
    stage_ = Stage::kFeeding;
    return Step::kMelt;
  }
  if (barrier_) {
    command_ = std::move(*barrier_);
    barrier_.reset();
    stage_ = Stage::kFeeding;
    if (const auto* h = std::get_if<Home>(&command_.command)) {
      home(Home(*h), command_.line);
      return std::nullopt;
    }
    if (std::holds_alternative<canonical::InputShaping>(command_.command)) {
      begin_shaping(command_.line);
      return std::nullopt;
    }
    if (std::holds_alternative<canonical::PressureAdvance>(command_.command)) {
      begin_advance();
      return std::nullopt;
    }
    if (const auto* p = std::get_if<canonical::Probe>(&command_.command)) {
      probe_ = *p;
      probe_line_ = command_.line;
      stage_ = Stage::kProbes;
    }
    if (const auto* sync = std::get_if<canonical::SpindleSync>(&command_.command)) thread_ = {*sync};
    const auto* mesh = std::get_if<canonical::Mesh>(&command_.command);
    if (mesh != nullptr && mesh->what == canonical::Mesh::What::kBegin) touched_.clear();
    command_.line = line_of(command_.line);
    return Step::kBarrier;
  }
  if (std::exchange(probing_, false)) {
    stage_ = Stage::kProbed;
    return Step::kProbed;
  }
  stage_ = ends_ ? Stage::kEnded : Stage::kFeeding;
  return std::nullopt;
}

void JobPipeline::take(const canonical::Line& line) {
  const Command& command = line.command;
  if (is_any<Feed, Traverse, Arc, SetPosition>(command)) return take_motion(line);
  melt_.take(command);
  if (const auto* mode = std::get_if<PathMode>(&command)) path_mode_ = *mode;
  if (const auto* limits = std::get_if<Limits>(&command)) merge_limits(limits_, *limits);
  if (is_any<PathMode, Limits>(command)) return add_to_planner(line);
  if (std::holds_alternative<End>(command)) {
    ends_ = true;
    return drain(std::nullopt);
  }
  if (const auto* stored = std::get_if<StoredJob>(&command)) {
    if (stored->what == StoredJob::What::kPause) return drain(canonical::Line{line.line, Pause{}});
    return refuse(line_of(line.line), 0,
                  say("a job cannot manage stored jobs: M20 to M32 belong to a session"));
  }
  if (is_barrier(command, machine_.gcode.optional_stop)) return drain(line);
  if (std::holds_alternative<Pause>(command) || take_advance(line) || take_shaping(line)) return;
  if (!std::holds_alternative<FeedPerTurn>(command)) return events_.push_back(line);
  // Of the line's own motion, too.
  const canonical::Line before{line.line - 1, command};
  const auto later = [&](const canonical::Line& event) { return event.line > before.line; };
  events_.insert(std::find_if(events_.begin(), events_.end(), later), before);
}

void JobPipeline::take_motion(const canonical::Line& line) {
  const auto target = target_of(line.command);
  const bool feeds = is_any<Feed, Traverse, Arc>(line.command) && target &&
                     target->pose[kE] > planner_.end_pose()[kE] + kNoFilament_mm;
  if (feeds && melt_.is_to_be_awaited()) {
    melt_.await();
    melt_due_ = true;
    first_.push_front(line);
    return drain(std::nullopt);
  }
  while (!scales_.empty() && scales_.front().move <= moves_taken_) {
    feed_scale_ = scales_.front().scale;
    scales_.pop_front();
  }
  ++moves_taken_;
  // The spindle says how fast a thread is.
  if (feed_scale_ == 1 || thread_.sync.rpm > 0 || !is_any<Feed, Arc>(line.command))
    return add_to_planner(line);
  canonical::Line scaled = line;
  const auto scale = [this](auto& move) {
    move.feed_per_s *= feed_scale_;
    move.inverse_time_s /= feed_scale_;
  };
  if (auto* feed = std::get_if<Feed>(&scaled.command)) scale(*feed);
  if (auto* arc = std::get_if<Arc>(&scaled.command)) scale(*arc);
  add_to_planner(scaled);
}

void JobPipeline::add_to_planner(const canonical::Line& line) {
  const auto added = planner_.add(line);
  if (added) return;
  refuse(line_of(added.error().line), 0, to_string(added.error()));
  // The planner refuses everything now. It goes on behind the refused move, so that later problems are seen
  // too.
  if (const auto target = target_of(line.command))
    start_at(target->pose, target->frame, line.line);
  else
    start_at(planner_.end_pose(), planner_.end_frame(), line.line);
}

void JobPipeline::drain(std::optional<canonical::Line> barrier) {
  barrier_ = std::move(barrier);
  stage_ = Stage::kDraining;
  if (const auto finished = planner_.finish(); !finished)
    refuse(finished.error().line, 0, to_string(finished.error()));
}

}  // namespace kinebus
