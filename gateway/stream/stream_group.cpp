#include "gateway/stream/stream_group.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>

namespace kinebus {
namespace {

JointSampler::Options with_maps(JointSampler::Options options, const std::vector<NodeAxes>& nodes) {
  for (const NodeAxes& node : nodes)
    for (const AxisScaling& axis : node.axes)
      if (axis.joint >= 0) options.maps[static_cast<std::size_t>(axis.joint)] = axis.map;
  return options;
}

BacklashTakeUp::Joints gaps_of(const std::vector<NodeAxes>& nodes) {
  BacklashTakeUp::Joints joints{};
  for (const NodeAxes& node : nodes)
    for (const AxisScaling& axis : node.axes)
      if (axis.joint >= 0)
        joints[static_cast<std::size_t>(axis.joint)] = {.gap = axis.gap,
                                                        .accel_per_s2 = axis.take_up_per_s2,
                                                        .hysteresis = 2 / std::abs(axis.slope()),
                                                        .home_side = axis.home_side};
  return joints;
}

}  // namespace

StreamGroup::StreamGroup(const Kinematics& kinematics, const std::vector<NodeAxes>& nodes,
                         const Options& options)
    : options_(options),
      sampler_(kinematics, with_maps(options.sampler, nodes)),
      take_up_(gaps_of(nodes)),
      budget_(options.budget) {
  options_.stream.acceleration_shift = options_.segmenter.acceleration_shift;
  nodes_.reserve(nodes.size());
  for (const NodeAxes& node : nodes)
    nodes_.push_back({Segmenter(node, options_.segmenter), NodeStream(node.node_id, options_.stream)});
}

StreamGroup::Node* StreamGroup::find(std::uint8_t node_id) {
  for (Node& node : nodes_)
    if (node.stream.node_id() == node_id) return &node;
  return nullptr;
}

const StreamGroup::Node* StreamGroup::find(std::uint8_t node_id) const {
  return const_cast<StreamGroup*>(this)->find(node_id);
}

void StreamGroup::set_state(std::uint8_t node_id, const std::array<AxisState, kAxesPerNode>& states,
                            const StreamStatus& status) {
  assert(may_begin());
  if (Node* node = find(node_id)) node->stream.reset(states, status.next_sequence, status.free_records);
}

void StreamGroup::begin_run() {
  assert(may_begin());
  sampler_.restart();
  take_up_.restart();
  for (Node& node : nodes_) {
    node.segmenter.start(node.stream.final_state());
    node.stream.push_start();
    node.end_pushed = false;
  }
  released_ = false;
  start_units_ = 0;
  state_ = State::kFilling;
}

bool StreamGroup::may_begin() const {
  if (state_ == State::kIdle || state_ == State::kDone) return true;
  return state_ == State::kRunning && complete() && all_accepted();
}

bool StreamGroup::wants_phases(PathTime tau) const {
  if (state_ != State::kFilling && state_ != State::kRunning) return false;
  if (!sampler_.wants_phase()) return false;
  const double now_s = released_ ? to_seconds(tau) - to_seconds(run_start()) : 0.0;
  return sampler_.end_s() - std::max(now_s, 0.0) < options_.lead_s;
}

Result<void, StreamError> StreamGroup::push(const Phase& phase) {
  if (auto ok = sampler_.push(phase); !ok) return ok;
  return pump();
}

void StreamGroup::drain(Node& node) {
  while (node.stream.has_room()) {
    const auto segment = node.segmenter.next();
    if (!segment) break;
    node.stream.push(*segment);
  }
  if (node.segmenter.ended() && !node.end_pushed) {  // found with room for it
    node.stream.push_end();
    node.end_pushed = true;
  }
}

Result<void, StreamError> StreamGroup::pump() {
  if (state_ != State::kFilling && state_ != State::kRunning) return {};
  for (Node& node : nodes_) drain(node);
  const auto room = [](const Node& node) { return node.segmenter.has_room() && node.stream.has_room(); };
  while (std::all_of(nodes_.begin(), nodes_.end(), room)) {
    std::optional<JointSpan> taken_up;
    if (take_up_.needed()) taken_up = take_up_.next();
    if (!taken_up) {
      const auto sampled = sampler_.next();
      if (!sampled) return Error<StreamError>(sampled.error());
      if (*sampled == nullptr) break;
      if (!take_up_.needed()) {
        if (auto ok = feed(**sampled); !ok) return ok;
        continue;
      }
      take_up_.push(**sampled);
      taken_up = take_up_.next();
    }
    if (auto ok = feed(*taken_up); !ok) return ok;
  }
  return {};
}

Result<void, StreamError> StreamGroup::feed(const JointSpan& span) {
  for (Node& node : nodes_) {
    node.segmenter.push(span);
    if (node.segmenter.start_offset_counts() > options_.start_offset_counts)
      return Error<StreamError>({.kind = StreamError::Kind::kStartMismatch,
                                 .node_id = node.stream.node_id(),
                                 .line = span.line,
                                 .amount = node.segmenter.start_offset_counts()});
    drain(node);
  }
  return {};
}

void StreamGroup::release(PathTime start) {
  assert(state_ == State::kFilling && !released_);
  start_units_ = (start.count() + kPathTicksPerUnit - 1) / kPathTicksPerUnit;
  for (Node& node : nodes_) node.stream.release(start_units_);
  released_ = true;
  state_ = State::kRunning;
}

void StreamGroup::cancel() {
  // Of a run that was not released no turn has come.
  if (state_ != State::kDone) take_up_.abandon(state_ == State::kRunning ? run_time(last_tau_) : 0.0);
  state_ = State::kIdle;
  sampler_.restart();
}

std::optional<CanFrame> StreamGroup::next_frame(BusTime now, PathTime tau) {
  if (state_ != State::kRunning) return std::nullopt;
  last_tau_ = tau;
  NodeStream* first = nullptr;
  for (Node& node : nodes_)
    if (node.stream.has_frame(tau) &&
        (first == nullptr || node.stream.sent_until_units() < first->sent_until_units()))
      first = &node.stream;
  return first == nullptr ? std::nullopt : first->next_frame(now, tau);
}

Result<void, StreamError> StreamGroup::on_status(BusTime now, std::uint8_t node_id,
                                                 const StreamStatus& status, PathTime tau) {
  Node* node = find(node_id);
  if (node == nullptr) return {};
  if (auto ok = node->stream.on_status(now, status, tau); !ok) return ok;
  if (auto ok = pump(); !ok) return ok;
  if (run_done(tau)) state_ = State::kDone;
  return {};
}

bool StreamGroup::complete() const {
  return std::all_of(nodes_.begin(), nodes_.end(), [](const Node& node) { return node.end_pushed; });
}

bool StreamGroup::primed(PathTime tau) const {
  const std::int64_t from = std::max(tau.count() / kPathTicksPerUnit, start_units_);
  const std::int64_t enough = from + options_.budget.confirmed().count();
  return released_ && std::all_of(nodes_.begin(), nodes_.end(), [&](const Node& node) {
           const auto status = node.stream.last_status();
           return (node.end_pushed && node.stream.all_accepted()) ||
                  node.stream.accepted_until_units() >= enough || (status && status->free_records == 0);
         });
}

bool StreamGroup::run_done(PathTime tau) const {
  if (state_ == State::kDone) return true;
  return state_ == State::kRunning && complete() && tau >= fitted_until() && all_accepted();
}

bool StreamGroup::all_accepted() const {
  return std::all_of(nodes_.begin(), nodes_.end(),
                     [](const Node& node) { return node.stream.all_accepted(); });
}

PathTime StreamGroup::confirmed(PathTime tau) const {
  PathTime least = tau;
  for (const Node& node : nodes_) {
    const auto status = node.stream.last_status();
    if (!status) continue;
    const std::int64_t here = tau.count() / kPathTicksPerUnit;
    least = std::min(least, PathTime{status->path_near(here) * kPathTicksPerUnit});
  }
  return least;
}

double StreamGroup::allowed_rate(PathTime tau) const {
  if (state_ != State::kRunning) return 1;
  std::array<const NodeStream*, kMostNodes> streams{};
  for (std::size_t i = 0; i < nodes_.size(); ++i) streams[i] = &nodes_[i].stream;
  return budget_.allowed_rate({streams.data(), nodes_.size()}, tau, complete());
}

PathTime StreamGroup::fitted_until() const {
  // Before END all nodes have about the same; behind it the one that settled last counts.
  std::int64_t least = std::numeric_limits<std::int64_t>::max(), most = 0;
  for (const Node& node : nodes_) {
    least = std::min(least, node.segmenter.knot_units());
    most = std::max(most, node.segmenter.knot_units());
  }
  return PathTime{(start_units_ + (complete() ? most : least)) * kPathTicksPerUnit};
}

std::optional<std::array<AxisState, kAxesPerNode>> StreamGroup::state_at(std::uint8_t node_id,
                                                                         PathTime tau) const {
  const Node* node = find(node_id);
  return node == nullptr ? std::nullopt : node->stream.state_at(tau);
}

std::optional<JointVector> StreamGroup::joints_at(PathTime tau) const {
  JointVector joints{};
  for (const Node& node : nodes_) {
    const auto states = node.stream.state_at(tau);
    if (!states) return std::nullopt;
    for (std::size_t i = 0; i < states->size(); ++i) {
      const AxisScaling& scaling = node.segmenter.node().axes[i];
      if (scaling.joint >= 0)
        joints[static_cast<std::size_t>(scaling.joint)] = scaling.to_joint(
            to_counts((*states)[i].position), take_up_.side_at(scaling.joint, run_time(tau)));
    }
  }
  return joints;
}

std::uint32_t StreamGroup::line_at(PathTime tau) const {
  return nodes_.empty() ? 0 : nodes_[0].stream.line_at(tau);
}

}  // namespace kinebus
