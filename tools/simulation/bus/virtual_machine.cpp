#include "tools/simulation/bus/virtual_machine.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tools/simulation/bus/virtual_machine_node.hpp"

namespace kinebus {
namespace {

// The edge of a switch is found within this time: at 4 mm/s of a slow approach 4 nm.
constexpr BusTime kFinestCheck{1'000};
// Far from any switch, or at rest, it is still looked at so often.
constexpr BusTime kCoarsestCheck{50'000'000};
constexpr int kMailboxes = 3;

}  // namespace

VirtualMachine::VirtualMachine(const std::vector<VirtualNodeOptions>& nodes, std::uint64_t seed,
                               int gateway_mailboxes)
    : gateway_(bus_.add_port(gateway_mailboxes)), random_(seed) {
  for (const VirtualNodeOptions& options : nodes)
    nodes_.push_back(
        std::make_unique<VirtualNode>(options, bus_.add_port(kMailboxes), static_cast<int>(nodes_.size())));
  for (const auto& node : nodes_)
    if (const auto& extruder = node->options.extruder)
      node->extruder = [&from = *nodes_[static_cast<std::size_t>(extruder->node)], to = node.get(),
                        extruder = *extruder](LocalTime at) {
        return from.counts(extruder.axis, to->to_true(at)) * extruder.mm_per_count;
      };
}

VirtualMachine::~VirtualMachine() = default;

std::optional<VirtualMachine::Received> VirtualMachine::receive() {
  if (next_received_ == received_.size()) {
    received_.clear();
    next_received_ = 0;
    return std::nullopt;
  }
  return received_[next_received_++];
}

BusTime VirtualMachine::next_event() const {
  return std::min(next_besides_probe(), next_probe_check_);
}

BusTime VirtualMachine::next_event(BusTime looks) const {
  BusTime next = std::min(bus_.next_event(), std::max(next_event(), looks));
  for (const auto& node : nodes_) next = std::min(next, node->next_besides_checks());
  if (!gateway_pending_.empty()) next = std::min(next, gateway_pending_.front().at);
  return next;
}

BusTime VirtualMachine::next_besides_probe() const {
  BusTime next = bus_.next_event();
  for (const auto& node : nodes_) next = std::min(next, node->next_due());
  if (!gateway_pending_.empty()) next = std::min(next, gateway_pending_.front().at);
  return next;
}

void VirtualMachine::deliver(const BusModel::Delivery& delivery) {
  std::vector<Arrival> arrivals;
  const auto disturbed = [&](int station, BusTime at) -> std::vector<Arrival>& {
    arrivals.assign(1, {at, delivery.frame});
    arrival_hook_(station, arrivals);
    return arrivals;
  };
  if (delivery.from == gateway_ || !arrival_hook_)
    received_.push_back({delivery.end, delivery.from == gateway_, delivery.frame, delivery.from});
  else
    for (const Arrival& arrival : disturbed(kGatewayStation, delivery.end))
      if (arrival.at <= delivery.end)
        received_.push_back({delivery.end, false, arrival.frame, delivery.from});
      else
        take_in_at_gateway(arrival);
  for (const auto& node : nodes_) {
    if (!node->powered()) continue;
    if (node->port == delivery.from) {
      serve(*node, delivery.end);  // its mailbox is free again
      continue;
    }
    BusTime at = delivery.end;
    if (node->options.latency_max > BusTime{0})
      at += BusTime{static_cast<std::int64_t>(
          random_() % static_cast<std::uint64_t>(node->options.latency_max.count() + 1))};
    if (!arrival_hook_) {
      take_in(*node, {at, delivery.frame});
      continue;
    }
    for (const Arrival& arrival : disturbed(node->index, at)) {
      if (arrival.at == at) {
        take_in(*node, arrival);
        continue;
      }
      // Delayed on purpose: others may overtake it.
      put(node->pending, arrival);
    }
  }
}

void VirtualMachine::take_in(VirtualNode& node, Arrival arrival) {
  if (node.stalled && node.pending.size() >= kStallQueue) {
    ++node.lost_while_stalled;
    return;
  }
  // Interrupts are served in order: a later frame never overtakes an earlier one.
  if (!node.pending.empty() && !arrival_hook_) arrival.at = std::max(arrival.at, node.pending.back().at);
  put(node.pending, arrival);
}

void VirtualMachine::put(std::vector<Pending>& pending, const Arrival& arrival) {
  const auto place = std::upper_bound(pending.begin(), pending.end(), arrival.at,
                                      [](BusTime at, const Pending& p) { return at < p.at; });
  pending.insert(place, {arrival.at, arrival.frame, arrival.at});
}

void VirtualMachine::take_in_at_gateway(const Arrival& arrival) {
  const auto place = std::upper_bound(gateway_pending_.begin(), gateway_pending_.end(), arrival,
                                      [](const Arrival& a, const Arrival& b) { return a.at < b.at; });
  gateway_pending_.insert(place, arrival);
}

BusModel::Port VirtualMachine::node_port(int node) const {
  return nodes_[static_cast<std::size_t>(node)]->port;
}

bool VirtualMachine::powered(int node) const {
  return nodes_[static_cast<std::size_t>(node)]->powered();
}

void VirtualMachine::serve(VirtualNode& node, BusTime now) {
  node.deadline = node.core ? node.put_out(*node.core, bus_, now) : node.put_out(*node.heat, bus_, now);
}

void VirtualMachine::check_switches(VirtualNode& node, BusTime now) {
  BusTime next = now + kCoarsestCheck;
  for (int axis = 0; axis < 2; ++axis) {
    const VirtualAxis& a = node.options.axes[static_cast<std::size_t>(axis)];
    if (a.switch_input == 0) continue;
    const double above = node.counts(axis, now) - a.switch_counts;
    const bool active = a.active_above ? above >= 0 : above <= 0;
    const int level = active != a.active_low ? 1 : 0;
    if (level != node.switch_level[static_cast<std::size_t>(axis)]) {
      node.switch_level[static_cast<std::size_t>(axis)] = level;
      std::vector<Edge> edges{{now, level == 1}};
      if (switch_hook_) switch_hook_(node.index, a.switch_input, edges);
      VirtualNode& wired = a.switch_node < 0 ? node : *nodes_[static_cast<std::size_t>(a.switch_node)];
      for (const Edge& edge : edges)
        if (edge.at <= now && &wired == &node && !node.stalled)
          node.core->on_switch(node.to_local(now), a.switch_input - 1, edge.level);
        else
          wired.edges.push_back({edge.at, a.switch_input, edge.level});
    }
    const BusTime nearest{static_cast<std::int64_t>(1e9 * std::abs(above) / a.max_counts_per_s)};
    next = std::min(next, now + std::max(nearest, kFinestCheck));
  }
  node.next_check = next;
}

void VirtualMachine::set_probe(VirtualProbe probe) {
  probe_ = std::move(probe);
  next_probe_check_ = BusTime{0};
  probe_touches_.reset();
}

void VirtualMachine::check_probe(BusTime now) {
  probe_counts_.clear();
  for (const auto& node : nodes_) probe_counts_.push_back({node->counts(0, now), node->counts(1, now)});
  const double gap = probe_->gap_mm(probe_counts_);
  bool touches = gap <= 0;
  if (probe_->pin_node >= 0) {
    heat::PinProbePlant& pin = heat_plant(probe_->pin_node).pin_probe();
    pin.meet(gap);
    touches = pin.line();
  }
  if (touches != probe_touches_) {
    probe_touches_ = touches;
    auto& edges = nodes_[static_cast<std::size_t>(probe_->node)]->edges;
    const auto place =
        std::upper_bound(edges.begin(), edges.end(), now,
                         [](BusTime at, const VirtualNode::RawEdge& edge) { return at < edge.at; });
    edges.insert(place, {now, probe_->input, touches != probe_->active_low});
  }
  const BusTime nearest{static_cast<std::int64_t>(1e9 * std::abs(gap) / probe_->max_mm_per_s)};
  next_probe_check_ = now + std::clamp(nearest, kFinestCheck, kCoarsestCheck);
}

bool VirtualMachine::advance(BusTime now) {
  for (;;) {
    if (next_probe_check_ <= now && next_probe_check_ <= next_besides_probe()) {
      check_probe(next_probe_check_);
      continue;
    }
    VirtualNode* due = nullptr;
    BusTime next = bus_.next_event();
    for (const auto& node : nodes_)
      if (node->next_due() < next) {
        next = node->next_due();
        due = node.get();
      }
    if (!gateway_pending_.empty() && gateway_pending_.front().at <= std::min(next, now)) {
      received_.push_back({gateway_pending_.front().at, false, gateway_pending_.front().frame, -1});
      gateway_pending_.erase(gateway_pending_.begin());
      return false;
    }
    if (next > now) return true;
    if (due == nullptr) {
      if (const auto delivery = bus_.advance(next)) {
        deliver(*delivery);
        return false;
      }
      continue;
    }
    due->count_scales(next);
    if (!due->options.heat && due->next_check <= next) check_switches(*due, next);
    if (due->stalled) continue;
    if (!due->edges.empty() && due->edges.front().at <= next) {
      const VirtualNode::RawEdge edge = due->edges.front();
      due->edges.erase(due->edges.begin());
      due->core->on_switch(due->to_local(next), edge.input - 1, edge.level);
    }
    if (!due->pending.empty() && due->pending.front().at <= next) {
      const Pending pending = due->pending.front();
      due->pending.erase(due->pending.begin());
      due->on_frame(due->to_local(pending.stamp), pending.frame);
    }
    if (due->deadline <= next || due->options.heat) due->on_time(due->to_local(next));
    serve(*due, next);
    // A deadline that stays in the past would stop time: the next turn is a microsecond later.
    due->deadline = std::max(due->deadline, next + BusTime{1'000});
  }
}

double VirtualMachine::true_counts(int node, int axis, BusTime at) {
  return nodes_[static_cast<std::size_t>(node)]->counts(axis, at);
}

std::optional<BusTime> VirtualMachine::stop_start(int node) const {
  const VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  const auto start = n.core ? n.core->path().stop_start() : std::nullopt;
  return start ? std::optional(n.to_true(*start)) : std::nullopt;
}

std::optional<double> VirtualMachine::believed_counts(int node, int axis, BusTime at) {
  VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  if (!n.core || !n.core->axis(axis).position_known()) return std::nullopt;
  return static_cast<double>(n.core->user_position(n.to_local(at), axis)) / 4294967296.0;
}

PathTime VirtualMachine::path_time(int node, BusTime at) {
  VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  if (n.options.heat)
    for (const auto& other : nodes_)
      if (!other->options.heat) return path_time(other->index, at);
  return n.core ? n.core->path_time(n.to_local(at)) : PathTime{0};
}

bool VirtualMachine::path_time_counts(int node, BusTime at) const {
  const VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  return n.core && (!n.core->path().stream().idle() || !n.core->path().at_rest(n.to_local(at)));
}

Node& VirtualMachine::node(int index) {
  return *nodes_[static_cast<std::size_t>(index)]->core;
}

heat::HeatNode& VirtualMachine::heat_node(int index) {
  return *nodes_[static_cast<std::size_t>(index)]->heat;
}

heat::HeatPlant& VirtualMachine::heat_plant(int index) {
  return *nodes_[static_cast<std::size_t>(index)]->plant;
}

heat::HeatPlant* VirtualMachine::heated(int node) {
  return nodes_[static_cast<std::size_t>(node)]->plant.get();
}

void VirtualMachine::set_input(int node, BusTime at, int input, bool level) {
  VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  if (!n.core) return;
  n.count_scales(at);
  n.core->on_switch(n.to_local(at), input - 1, level);
  serve(n, at);
}

}  // namespace kinebus
