#include "tools/simulation/simulation.hpp"

#include <algorithm>
#include <utility>

namespace kinebus {
namespace {
constexpr BusTime kShortestTurn = std::chrono::microseconds{20};
}  // namespace

Simulation::Simulation(const MachineDescription& machine, const Kinematics& kinematics,
                       const SimulationOptions& options)
    : Simulation(machine, kinematics, options,
                 virtual_machine_of(options.plant ? *options.plant : machine, options.clocks, options.seed)) {
}

Simulation::Simulation(const MachineDescription& machine, const Kinematics& kinematics,
                       const SimulationOptions& options, std::unique_ptr<NodeMachine> nodes)
    : description_(machine),
      kinematics_(kinematics),
      options_(options),
      nodes_(std::move(nodes)),
      random_(options.seed ^ 0x9E3779B97F4A7C15ULL),
      warm_{kinematics.bed_reference(), kinematics.bed_reference()} {
  for (const JointDescription& joint : machine.joints)
    for (std::size_t n = 0; n < machine.nodes.size(); ++n)
      if (machine.nodes[n].id == joint.node_id) node_of_joint_.push_back(static_cast<int>(n));
  for (const JointDescription& joint : (options.plant ? *options.plant : machine).joints)
    plants_.emplace_back(joint);
  if (options.plant)
    if (auto made = make_kinematics(*options.plant)) plant_kinematics_ = std::move(*made);
  start_gateway();
}

std::uint8_t Simulation::next_epoch() {
  return static_cast<std::uint8_t>(1 + (options_.seed + gateways_.size()) % 250);
}

void Simulation::kill_gateway() {
  alive_ = false;
}

bool Simulation::start_gateway(std::unique_ptr<ByteSource> job) {
  gateways_.push_back(std::make_unique<Gateway>(
      description_, Gateway::Options{.epoch = next_epoch(),
                                     .bus_secret = {.low = options_.seed + 1, .high = gateways_.size()},
                                     .journal = options_.journal}));
  alive_ = true;
  asked_ = BusTime::max();
  journal_records_ = 0;
  gateway().on_time(now_);
  // Without its job's text what is the machine's own is taken up alone.
  if (!job && (journal_.job || !options_.journal)) return true;
  return static_cast<bool>(gateway().recover(journal_, std::move(job)));
}

std::optional<PlannedPose> Simulation::planned_pose(PathTime tau) const {
  // A new gateway plans the rest of a job anew; until it moves, what the one before had planned counts.
  const MachineState state = gateways_.back()->state();
  const bool idle =
      state == MachineState::kOff || state == MachineState::kBringUp || state == MachineState::kReady;
  if (!idle || gateways_.size() == 1) return gateways_.back()->planned_pose(tau);
  return gateways_[gateways_.size() - 2]->planned_pose(tau);
}

void Simulation::hash(BusTime when, const CanFrame& frame) {
  const auto mix = [&](std::uint64_t value) { hash_ = (hash_ ^ value) * 1099511628211ULL; };
  mix(static_cast<std::uint64_t>(when.count()));
  mix(frame.id);
  for (const std::uint8_t byte : frame.bytes()) mix(byte);
}

BusTime Simulation::gateway_due() {
  if (!alive_) return BusTime::max();
  const BusTime deadline = gateway().next_deadline();
  if (deadline != asked_) {
    asked_ = deadline;
    woken_ = deadline;
    if (deadline != BusTime::max() && options_.gateway_latency_max > BusTime{0})
      woken_ += BusTime{static_cast<std::int64_t>(
          random_() % static_cast<std::uint64_t>(options_.gateway_latency_max.count()))};
    if (deadline != BusTime::max() && options_.gateway_delay) woken_ += options_.gateway_delay(now_);
  }
  // A task that has just run does not run again in the same instant.
  return std::max({woken_, served_ + kShortestTurn, now_});
}

void Simulation::serve_gateway(BusTime now) {
  if (!alive_) return;
  while (nodes_->can_send()) {
    const auto frame = gateway().next_frame(now);
    if (!frame) break;
    nodes_->send(now, *frame);
  }
  const std::uint64_t stored = journal_records_;
  while (const auto record = gateway().next_journal_record()) journal_.take(*record), ++journal_records_;
  if (journal_records_ != stored) gateway().on_journal_stored(journal_records_);
  while (auto event = gateway().next_event())
    if (on_event) on_event(*event);
}

void Simulation::step(BusTime until) {
  const BusTime gateway_time = gateway_due();
  const BusTime next =
      std::min({until, next_sample_, next_probe_, gateway_time, std::max(nodes_->next_event(), now_)});
  const bool done = nodes_->advance(next);
  bool stirred = false;
  while (const auto got = nodes_->receive()) {
    now_ = std::max(now_, got->when);
    hash(got->when, got->frame);
    if (on_frame) on_frame(got->when, got->frame);
    if (on_received) on_received(*got);
    if (!alive_) continue;
    if (got->own)
      gateway().on_frame_sent(got->when, got->frame);
    else
      gateway().on_frame(got->when, got->frame);
    stirred = true;
  }
  if (done) now_ = std::max(now_, next);
  if (done && now_ >= gateway_time) {
    gateway().on_time(now_);
    served_ = now_;
    asked_ = BusTime::max();
    stirred = true;
  }
  if (stirred) serve_gateway(now_);
  if (on_turn) on_turn(now_);
  if (done && now_ >= next_probe_) {
    const BusTime period = options_.sample_period;
    next_probe_ = period * (now_ / period + 1) +
                  BusTime{static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(period.count()))};
    if (on_probe) on_probe(probe());
  }
  if (done && now_ >= next_sample_) {
    next_sample_ += options_.sample_period;
    if (on_sample) on_sample(sample());
  }
}

void Simulation::run_until(BusTime until) {
  serve_gateway(now_);
  while (now_ < until) step(until);
}

bool Simulation::run_until_state(const std::function<bool(MachineState)>& done, BusTime limit) {
  serve_gateway(now_);
  const BusTime until = now_ + limit;
  while (!done(gateway().state())) {
    if (now_ >= until) return false;
    step(until);
  }
  return true;
}

Probe Simulation::probe() {
  Probe p;
  p.time = now_;
  p.node_count = std::min(nodes_->node_count(), kMaxNodes);
  for (int n = 0; n < p.node_count; ++n) p.tau[static_cast<std::size_t>(n)] = nodes_->path_time(n, now_);
  return p;
}

Sample Simulation::sample() {
  Sample s;
  s.time = now_;
  s.in_job = in_job;
  const Probe now = probe();
  s.node_count = now.node_count;
  s.node_tau = now.tau;
  std::int64_t sum = 0;
  for (int n = 0; n < s.node_count; ++n)
    sum += (s.node_tau[static_cast<std::size_t>(n)] - s.node_tau[0]).count();
  s.tau = s.node_tau[0] + PathTime{s.node_count > 0 ? sum / s.node_count : 0};
  const BusTime dt = s.time - last_.time;
  if (dt > BusTime{0}) s.rate = to_seconds(s.tau - last_.tau) / to_seconds(dt);

  for (std::size_t j = 0; j < description_.joints.size(); ++j) {
    const JointDescription& joint = description_.joints[j];
    s.joints[j] = plants_[j].at(nodes_->true_counts(node_of_joint_[j], joint.axis, now_));
  }
  if (in_job) {
    s.planned = planned_pose(s.tau);
    s.line = s.planned ? s.planned->line : last_.line;
  }
  last_ = s;
  return s;
}

void Simulation::locate(Sample& sample) {
  // Begins where the pose goes on to: one step of Newton's method then is enough.
  for (std::size_t axis = 0; axis < sample.pose.size(); ++axis)
    sample.pose[axis] = 2 * warm_[0][axis] - warm_[1][axis];
  const Kinematics& real = plant_kinematics_ ? *plant_kinematics_ : kinematics_;
  if (real.forward(Frame::kPart, sample.joints, sample.pose)) warm_ = {sample.pose, warm_[0]};
}

}  // namespace kinebus
