#include "node_firmware/port/host/virtual_machine.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {
namespace {

// The edge of a switch is found within this time: at 4 mm/s of a slow approach 4 nm.
constexpr BusTime kFinestCheck{1'000};
// Far from any switch, or at rest, it is still looked at so often.
constexpr BusTime kCoarsestCheck{50'000'000};
constexpr int kMailboxes = 3;

}  // namespace

struct VirtualMachine::VirtualNode {
  VirtualNode(const VirtualNodeOptions& o, BusModel::Port p)
      : options(o), port(p), core(o.node, to_local(BusTime{0})) {}

  LocalTime to_local(BusTime t) const {
    return t + options.clock_offset +
           LocalTime{std::llround(static_cast<double>(t.count()) * options.clock_drift_ppm * 1e-6)};
  }
  BusTime to_true(LocalTime t) const {
    if (t == LocalTime::max()) return BusTime::max();
    const double since = static_cast<double>((t - options.clock_offset).count());
    // Rounded up, so that a deadline is never served a nanosecond early.
    return BusTime{static_cast<std::int64_t>(std::ceil(since / (1 + options.clock_drift_ppm * 1e-6))) + 1};
  }
  double counts(int axis, BusTime at) {
    return options.axes[static_cast<std::size_t>(axis)].start_counts +
           static_cast<double>(core.position(to_local(at), axis)) / 4294967296.0;
  }
  BusTime next_due() const {
    return std::min({deadline, next_check, pending.empty() ? BusTime::max() : pending.front().at});
  }

  VirtualNodeOptions options;
  BusModel::Port port;
  Node core;
  std::vector<Pending> pending;
  BusTime deadline{0};
  BusTime next_check{0};
  std::array<int, 2> switch_level{-1, -1};
};

VirtualMachine::VirtualMachine(const std::vector<VirtualNodeOptions>& nodes, std::uint64_t seed,
                               int gateway_mailboxes)
    : gateway_(bus_.add_port(gateway_mailboxes)), random_(seed) {
  for (const VirtualNodeOptions& options : nodes)
    nodes_.push_back(std::make_unique<VirtualNode>(options, bus_.add_port(kMailboxes)));
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
  BusTime next = bus_.next_event();
  for (const auto& node : nodes_) next = std::min(next, node->next_due());
  return next;
}

void VirtualMachine::deliver(const BusModel::Delivery& delivery) {
  received_.push_back({delivery.end, delivery.from == gateway_, delivery.frame});
  for (const auto& node : nodes_) {
    if (node->port == delivery.from) {
      serve(*node, delivery.end);  // its mailbox is free again
      continue;
    }
    BusTime at = delivery.end;
    if (node->options.latency_max > BusTime{0})
      at += BusTime{static_cast<std::int64_t>(
          random_() % static_cast<std::uint64_t>(node->options.latency_max.count() + 1))};
    // Interrupts are served in order: a later frame never overtakes an earlier one.
    if (!node->pending.empty()) at = std::max(at, node->pending.back().at);
    node->pending.push_back({at, delivery.frame});
  }
}

void VirtualMachine::serve(VirtualNode& node, BusTime now) {
  // Parameters are stored at once; a virtual node powers up with its defaults all the same.
  if (!node.core.image_to_store().empty()) node.core.on_image_stored(true);
  while (bus_.has_room(node.port)) {
    const auto frame = node.core.next_frame();
    if (!frame) break;
    bus_.send(node.port, now, *frame);
  }
  node.deadline = node.to_true(node.core.next_deadline());
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
      node.core.on_switch(node.to_local(now), a.switch_input - 1, level == 1);
    }
    const BusTime nearest{static_cast<std::int64_t>(1e9 * std::abs(above) / a.max_counts_per_s)};
    next = std::min(next, now + std::max(nearest, kFinestCheck));
  }
  node.next_check = next;
}

bool VirtualMachine::advance(BusTime now) {
  for (;;) {
    VirtualNode* due = nullptr;
    BusTime next = bus_.next_event();
    for (const auto& node : nodes_)
      if (node->next_due() < next) {
        next = node->next_due();
        due = node.get();
      }
    if (next > now) return true;
    if (due == nullptr) {
      if (const auto delivery = bus_.advance(next)) {
        deliver(*delivery);
        return false;
      }
      continue;
    }
    if (due->next_check <= next) check_switches(*due, next);
    if (!due->pending.empty() && due->pending.front().at <= next) {
      const CanFrame frame = due->pending.front().frame;
      due->pending.erase(due->pending.begin());
      due->core.on_frame(due->to_local(next), frame);
    }
    if (due->deadline <= next) due->core.on_time(due->to_local(next));
    serve(*due, next);
    // A deadline that stays in the past would stop time: the next turn is a microsecond later.
    due->deadline = std::max(due->deadline, next + BusTime{1'000});
  }
}

double VirtualMachine::true_counts(int node, int axis, BusTime at) {
  return nodes_[static_cast<std::size_t>(node)]->counts(axis, at);
}

PathTime VirtualMachine::path_time(int node, BusTime at) {
  VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  return n.core.path_time(n.to_local(at));
}

Node& VirtualMachine::node(int index) {
  return nodes_[static_cast<std::size_t>(index)]->core;
}

void VirtualMachine::set_input(int node, BusTime at, int input, bool level) {
  VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  n.core.on_switch(n.to_local(at), input - 1, level);
  serve(n, at);
}

}  // namespace kinebus
