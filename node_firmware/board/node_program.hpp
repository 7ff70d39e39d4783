#pragma once
// A node's core on a board: feeds it frames, edges and time in their order, and carries out what it says.
// One pass of the main loop; interrupts come through the ports.

#include <algorithm>
#include <array>
#include <utility>

#include "node_firmware/board/drivers.hpp"
#include "node_firmware/board/local_clock.hpp"
#include "node_firmware/core/motion_plan.hpp"
#include "node_firmware/core/node.hpp"

namespace kinebus {

template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter>
class NodeProgram {
 public:
  NodeProgram(const NodeOptions& options, std::span<const std::uint8_t> stored, Can& can, Switches& switches,
              MotionPlanExchange& plan)
      : can_(can), switches_(switches), plan_(plan), now_(clock_.now()), node_(options, now_, stored) {
    plan_.renew(node_, now_, Counter::counts());
    filter();
  }

  /// Everything that has come since the last pass. Call at least every millisecond.
  void pass();
  /// The power stage does not measure: an axis that is switched on has a fault. True: so it was.
  bool refuse_power();
  /// Something was told to the node elsewhere: the next pass looks what follows from it.
  void touch() { touched_ = true; }
  Node& node() { return node_; }
  LocalTime now() const { return now_; }
  /// now(), read afresh: a pass may have taken a while.
  LocalTime read_time() { return now_ = clock_.now(); }
  /// Hands what the node has to say to the bus, as far as there is room.
  void send();
  PathTime path_time(std::uint32_t counts) const { return node_.path_time(clock_.at(counts)); }

 private:
  bool take_inputs();
  void filter();
  void report_bus();

  // Half of the plan's horizon: a main loop that is late by the other half harms nothing.
  static constexpr LocalTime kPlanPeriod = kPlanCount * (MotionPlan::kHorizon / 2);
  static constexpr LocalTime kFilterPeriod = std::chrono::milliseconds{10};
  // Frames of one pass; more wait for the next, so that what is due in between is served.
  static constexpr int kInputsPerPass = 8;

  Can& can_;
  Switches& switches_;
  MotionPlanExchange& plan_;
  LocalClock<Counter> clock_;
  LocalTime now_;
  Node node_;
  LocalTime due_{0}, plan_due_{0}, filter_due_{0};
  bool touched_ = true;
  std::array<CanAccept, kCanFilters> filters_{};
  CanEvents told_;
  bool was_off_ = false;
};

template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter>
void NodeProgram<Can, Switches, Counter>::pass() {
  now_ = clock_.now();
  const bool input = can_.front() != nullptr || switches_.front() != nullptr;
  if (!input && !touched_ && now_ < due_) {
    // Nothing to do for the node: most passes end here.
    if (!can_.queue().idle()) send();
    return;
  }
  bool changed = take_inputs() || std::exchange(touched_, false);
  if (now_ >= node_.next_deadline()) {
    node_.on_time(now_);
    changed = true;
  }
  // The plan begins now, and never before what the node knows.
  const std::uint32_t counts = Counter::counts();
  const LocalTime from = clock_.at(counts);
  if (now_ >= plan_due_ || (changed && plan_.outdated(node_, from, counts))) {
    plan_.renew(node_, from, counts);
    plan_due_ = now_ + kPlanPeriod;
  }
  // Before the answer: who has it may send at once what was asked for.
  if (now_ >= filter_due_) filter();
  send();
  report_bus();
  due_ = std::min({node_.next_deadline(), plan_due_, filter_due_});
}

// Frames and edges in the order in which they happened.
template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter>
bool NodeProgram<Can, Switches, Counter>::take_inputs() {
  int taken = 0;
  for (; taken < kInputsPerPass; ++taken) {
    const auto* frame = can_.front();
    const SwitchEdge* edge = switches_.front();
    const bool edge_first =
        edge != nullptr && (frame == nullptr || static_cast<std::int32_t>(edge->counts - frame->counts) < 0);
    if (edge_first) {
      node_.on_switch(clock_.at(edge->counts), edge->input, edge->level);
      switches_.drop();
    } else if (frame != nullptr) {
      const CanFrame heard = frame->frame();
      node_.on_frame(clock_.at(frame->counts), heard);
      if (heard.id == cob_id::kSdoRequest + node_.node_id()) filter_due_ = now_;
      can_.drop();
    } else {
      break;
    }
  }
  return taken != 0;
}

template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter>
void NodeProgram<Can, Switches, Counter>::send() {
  can_.serve_mailboxes();
  while (can_.queue().has_room()) {
    const auto frame = node_.next_frame();
    if (!frame) return;
    can_.queue().push(*frame);
    can_.serve_mailboxes();
  }
}

template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter>
bool NodeProgram<Can, Switches, Counter>::refuse_power() {
  bool refused = false;
  for (int axis = 0; axis < kAxesPerNode; ++axis) {
    if (!node_.drive(axis).power) continue;
    node_.on_drive_fault(now_, axis, emcy::kControlHardware);
    refused = true;
  }
  return refused;
}

// What this node has to hear: its own requests and PDOs, what all hear, and the heartbeats that it watches.
template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter>
void NodeProgram<Can, Switches, Counter>::filter() {
  filter_due_ = now_ + kFilterPeriod;
  std::array<CanAccept, kCanFilters> wanted{};
  std::size_t count = 0;
  const auto add = [&](std::uint32_t value, std::uint32_t mask = 0x7FF) {
    wanted[count++] = {static_cast<std::uint16_t>(value), static_cast<std::uint16_t>(mask)};
  };
  add(0x000);         // NMT
  add(0x080, 0x780);  // SYNC, and the EMCYs of others: stop requests
  add(0x7E5);         // LSS
  if (node_.node_id() != 0) {
    add(0x600u + node_.node_id());
    for (const std::uint8_t id : node_.watched_nodes())
      if (id != 0) add(0x700u + id);
    for (const std::uint16_t id : node_.rpdo_cob_ids())
      if (id != 0) add(id);
  }
  if (wanted == filters_) return;
  filters_ = wanted;
  can_.accept(std::span(wanted).first(count));
}

template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter>
void NodeProgram<Can, Switches, Counter>::report_bus() {
  const CanEvents events = can_.events();
  if (events.overruns != told_.overruns) {
    node_.on_receive_overrun(now_, events.overruns - told_.overruns);
    node_.report(emcy::kCanOverrun);
  }
  if (events.passive != told_.passive) node_.report(emcy::kErrorPassive);
  if (events.bus_off != told_.bus_off) node_.count(NodeCounter::kBusOff, events.bus_off - told_.bus_off);
  const bool off = can_.bus_off();
  // Told when the bus can hear it again.
  if ((was_off_ && !off) || (!off && !was_off_ && events.bus_off != told_.bus_off))
    node_.report(emcy::kBusOffRecovered);
  was_off_ = off;
  told_ = events;
}

}  // namespace kinebus
