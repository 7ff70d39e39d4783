#include "gateway/jobs/job_plan.hpp"

#include <algorithm>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/stream/sync_producer.hpp"
#include "protocol/can/bit_length.hpp"

namespace kinebus {
namespace {

/// Virtual time between two looks at the streams. Short against the horizon (400 ms) and a status period.
constexpr BusTime kTick = std::chrono::milliseconds{20};
/// The rate that the bus allows looks half a second ahead.
constexpr BusTime kRatePeriod = std::chrono::milliseconds{100};
/// From the first frame of a run to its START: the queues are filled meanwhile.
constexpr BusTime kStartLead = std::chrono::milliseconds{200};
/// What of a long wait is gone through frame by frame, at its beginning and its end: the background repeats
/// itself within it.
constexpr BusTime kSteady = std::chrono::seconds{10};
/// No plan goes beyond this, 200 years: its nanoseconds still fit.
constexpr BusTime kEndOfTime = std::chrono::hours{200 * 365 * 24};

PathTime path_time(double ticks) {
  return PathTime{static_cast<std::int64_t>(ticks)};
}
double ticks_of(BusTime duration) {
  return static_cast<double>(duration.count()) * 16e-3;
}

}  // namespace

JobPlan::JobPlan(const MachineDescription& machine, const Kinematics& kinematics, ByteSource& source)
    : pipeline_(machine, kinematics),
      check_(machine, kinematics),
      group_(kinematics, node_axes(machine), stream_options(machine)) {
  const Pose start = kinematics.bed_reference();
  pipeline_.start_job(source, start);
  JointVector joints{};
  if (const auto reached = kinematics.inverse(Frame::kMachine, start, joints); !reached) {
    check_.problem({Problem::Severity::kError, 0, 0, say("bed reference: %1", to_string(reached.error()))});
    streaming_ = false;
  }
  for (const NodeAxes& node : node_axes(machine)) {
    nodes_.emplace_back(node.node_id);
    std::array<AxisState, kAxesPerNode> states{};
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis)
      if (const AxisScaling& scaling = node.axes[axis]; scaling.joint >= 0)
        states[axis].position = to_fixed(scaling.to_counts(joints[static_cast<std::size_t>(scaling.joint)]));
    group_.set_state(node.node_id, states, nodes_.back().status(PathTime{0}));
  }
  // Typical contents: stuffing differs by a few bits.
  const auto bits = [](CanFrame frame) { return static_cast<std::int64_t>(bit_length(frame)); };
  const CanFrame sync = CanFrame::make(kSyncCobId, {77});
  const CanFrame stamp = encode(SyncStamp{77, 1, BusTime{1'234'567'890'123}});
  const CanFrame heartbeat = CanFrame::make(0x701, {5});
  const CanFrame state = CanFrame::make(0x181, {0x37, 0x06, 0x37, 0x06, 7, 7, 0});
  CanFrame status{.id = 0x281, .length = 8};
  put_u64_le(status.data, encode(StreamStatus{55, 60, 0x41, 3, 123'456'789}));
  status_bits_ = bits(status);
  background_.push_back({machine.bus.sync_period, BusTime{0}, bits(sync)});
  background_.push_back({machine.bus.sync_period, std::chrono::microseconds{300}, bits(stamp)});
  background_.push_back({machine.bus.heartbeat_period, BusTime{0}, bits(heartbeat)});  // the gateway's own
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    background_.push_back(
        {machine.bus.heartbeat_period, std::chrono::milliseconds{50 * (i + 1)}, bits(heartbeat)});
    background_.push_back({std::chrono::seconds{1}, std::chrono::milliseconds{70 * (i + 1)}, bits(state)});
  }
}

void JobPlan::count(std::int64_t bits) {
  ++report_.frames;
  load_.add(now_, bits);
}

/// Lets `duration` of bus time pass with the background traffic alone.
void JobPlan::pass(BusTime duration) {
  const BusTime end = now_ + std::min(duration, kEndOfTime - now_);
  if (end - now_ > 2 * kSteady) {
    pass(kSteady);
    now_ = end - kSteady;
    std::int64_t bits = 0;
    for (Background& b : background_) {
      if (b.due > now_) continue;
      const std::int64_t frames = (now_ - b.due) / b.period + 1;
      b.due += frames * b.period;
      report_.frames += static_cast<std::uint64_t>(frames);
      bits += frames * b.bits;
    }
    load_.skip(now_, bits);
  }
  while (now_ < end) {
    now_ = std::min(now_ + kTick, end);
    for (Background& b : background_)
      for (; b.due <= now_; b.due += b.period) count(b.bits);
  }
}

void JobPlan::tick() {
  if (now_ >= next_rate_) {
    next_rate_ = now_ + kRatePeriod;
    rate_ = group_.allowed_rate(path_time(tau_ticks_));
    report_.lowest_rate = std::min(report_.lowest_rate, rate_);
  }
  pass(kTick);
  tau_ticks_ += rate_ * ticks_of(kTick);
  const PathTime tau = path_time(tau_ticks_);
  while (const auto frame = group_.next_frame(now_, tau)) {
    count(static_cast<std::int64_t>(bit_length(*frame)));
    for (IdealNode& node : nodes_) node.on_frame(*frame);
  }
  for (IdealNode& node : nodes_) {
    if (!node.on_time(now_, tau)) continue;
    count(status_bits_);
    if (const auto taken = group_.on_status(now_, node.id(), node.status(tau), tau); !taken)
      return fail(taken.error());
  }
}

void JobPlan::fail(const StreamError& error) {
  streaming_ = false;
  check_.problem({Problem::Severity::kError, error.line, 0, to_string(error)});
}

/// Lets the run go on until it takes phases again.
void JobPlan::run_until_wanted() {
  while (streaming_ && !group_.wants_phases(path_time(tau_ticks_))) {
    if (!released_) {
      released_ = true;
      group_.release(path_time(tau_ticks_ + ticks_of(kStartLead)));
    }
    tick();
  }
}

void JobPlan::stream(const Phase& phase) {
  if (!in_run_) {
    group_.begin_run();
    in_run_ = true;
    released_ = false;
  }
  run_until_wanted();
  if (!streaming_) return;
  if (const auto pushed = group_.push(phase); !pushed) fail(pushed.error());
}

void JobPlan::end_run() {
  in_run_ = false;
  ++report_.runs;
  if (!streaming_) return;
  if (!released_) group_.release(path_time(tau_ticks_ + ticks_of(kStartLead)));
  released_ = true;
  // Far more ticks than the motion that can be buffered at the lowest rate: a run that does not end is a
  // defect.
  for (int guard = 0; streaming_ && !group_.run_done(path_time(tau_ticks_)); ++guard) {
    if (guard > 1'000'000) return fail({.kind = StreamError::Kind::kSilent});
    tick();
  }
}

bool JobPlan::take(JobPipeline::Step step) {
  using Step = JobPipeline::Step;
  switch (step) {
    case Step::kPhase:
      report_.motion_s += pipeline_.phase().duration_s;
      check_.phase(pipeline_.phase());
      if (streaming_) stream(pipeline_.phase());
      return false;
    case Step::kEvent:
    case Step::kBarrier:
      check_.command(pipeline_.command());
      count_command(pipeline_.command().command, report_);
      if (const auto* dwell = std::get_if<canonical::Dwell>(&pipeline_.command().command);
          dwell && streaming_) {
        const BusTime duration{static_cast<std::int64_t>(dwell->seconds * 1e9)};
        pass(duration);
        tau_ticks_ += ticks_of(duration);
      }
      return false;
    case Step::kRunEnd:
      end_run();
      return false;
    case Step::kMelt:
      return false;
    case Step::kProbed:
      pipeline_.probed(pipeline_.assumed_probe());
      return false;
    case Step::kProblem:
      streaming_ = false;
      tell_notes(pipeline_, check_);
      check_.problem(pipeline_.problem());
      return false;
    case Step::kMore:
    case Step::kStarved:
      tell_notes(pipeline_, check_);
      return true;
    case Step::kEnd:
      tell_notes(pipeline_, check_);
      finish();
      return true;
  }
  return true;
}

bool JobPlan::step(int lines) {
  for (;;) {
    const JobPipeline::Step step = pipeline_.next(lines);
    if (take(step)) return step == JobPipeline::Step::kEnd;
  }
}

void JobPlan::finish() {
  report_.lines = pipeline_.lines();
  report_.moves = pipeline_.planner().counters().moves;
  for (const IdealNode& node : nodes_) report_.segments += node.segments();
  load_.advance(now_);
  report_.bus_load_mean = load_.mean();
  report_.bus_load_peak_1s = load_.peak_second();
  report_.job_time_s = streaming_ ? to_seconds(now_) : report_.motion_s + report_.dwell_s;
}

}  // namespace kinebus
