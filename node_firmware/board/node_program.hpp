#pragma once
// The nodes of a board between its drivers and their cores: feeds them frames, edges and time in their order,
// and carries out what they say. One pass of the main loop; interrupts come through the ports.
//
// Several nodes share a CAN controller, which does not hear what it sends itself: what one of them says, the
// others are told here.

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "node_firmware/board/board_heat.hpp"
#include "node_firmware/board/board_node.hpp"
#include "node_firmware/board/drivers.hpp"

namespace kinebus {

/// kNodes: axis pairs; 0: none, and of the controller's troubles nobody tells but by their ends. Heat: the
/// board's heat node, a BoardHeat.
template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter, std::size_t kNodes = 1,
          typename Heat = NoHeat>
class NodeProgram {
 public:
  /// With its first node.
  NodeProgram(const NodeOptions& options, std::span<const std::uint8_t> stored, Can& can, Switches& switches,
              MotionPlanExchange& plan, InputPlaces inputs = {})
      : can_(can), switches_(switches), now_(clock_.now()) {
    begin(0, options, stored, plan, inputs);
    filter();
  }
  /// Of a board that has a heat node only.
  NodeProgram(Can& can, Switches& switches) requires(kNodes == 0)
      : can_(can), switches_(switches), now_(clock_.now()) {}
  /// Another one, or one anew.
  void begin(std::size_t number, const NodeOptions& options, std::span<const std::uint8_t> stored,
             MotionPlanExchange& plan, InputPlaces inputs) {
    nodes_[number].emplace(options, bus_clock_, clock_, now_, stored, plan, grid_, inputs);
    for (std::size_t i = 0; i < known_inputs_; ++i)
      nodes_[number]->on_switch(now_, static_cast<std::uint8_t>(i), levels_[i]);
  }
  void end(std::size_t number) {
    nodes_[number].reset();
    fewer_ = true;
  }

  /// Plans begin so from now on.
  void align_plans(const PlanGrid& grid) { grid_ = grid; }

  /// Everything that has come since the last pass. Call at least every millisecond.
  void pass();
  /// f(number, node): true, when the node was told something; the next pass looks what follows from it, and
  /// what it has to say is sent.
  template <typename Tell>
  void tell_each(Tell&& tell);
  Node& node(std::size_t number = 0) { return nodes_[number]->node(); }
  const Node& node(std::size_t number = 0) const { return nodes_[number]->node(); }
  bool has(std::size_t number) const { return nodes_[number].has_value(); }
  LocalTime now() const { return now_; }
  /// now(), read afresh: a pass may have taken a while.
  LocalTime read_time() { return now_ = clock_.now(); }
  bool healthy(LocalTime now) const {
    return heat_.healthy(now) &&
           std::ranges::all_of(nodes_, [&](const auto& n) { return !n || n->node().healthy(now); });
  }
  /// A node's program is to give way (1F51h = 0), and with it all of them.
  bool stop_requested() const {
    return heat_.stop_requested() ||
           std::ranges::any_of(nodes_, [](const auto& n) { return n && n->node().program_stop_requested(); });
  }
  Heat& heat() { return heat_; }
  PathTime path_time(std::uint32_t counts, std::size_t number = 0) const {
    return node(number).path_time(clock_.at(counts));
  }

 private:
  using Place = std::optional<BoardNode<Counter>>;
  void take_inputs();
  void on_edge(const SwitchEdge& edge);
  void send();
  void filter();
  bool bus_news() const { return kNodes != 0 && (can_.events() != told_ || can_.bus_off() != was_off_); }
  void report_bus();
  static std::optional<CanFrame> next_frame_of([[maybe_unused]] Place& place) {
    // A board without axes has no code of theirs.
    if constexpr (kNodes != 0)
      if (place) return place->next_frame();
    return std::nullopt;
  }
  template <typename Do>
  void each(Do&& do_it) {
    for (Place& place : nodes_)
      if (place) do_it(*place);
  }

  // Frames of one pass; more wait for the next, so that what is due in between is served.
  static constexpr int kInputsPerPass = [] {
    if constexpr (requires { Can::kInputsPerPass; }) return Can::kInputsPerPass;
    return 8;
  }();
  static constexpr std::size_t kMostInputs = 16;

  Can& can_;
  Switches& switches_;
  LocalClock<Counter> clock_;
  // Of all nodes: they hear the same SYNC by the same counter.
  BusClock bus_clock_{[] {
    if constexpr (requires { Counter::kClockWindow; }) return Counter::kClockWindow;
    return ClockEstimate::kWindow;
  }()};
  LocalTime now_;
  PlanGrid grid_;
  std::array<Place, kNodes> nodes_;
  Heat heat_;
  std::size_t first_ = 0;  // to say something
  std::array<bool, kMostInputs> levels_{};
  std::size_t known_inputs_ = 0;  // a port tells all levels when it starts
  bool fewer_ = false;
  CanEvents told_;
  bool was_off_ = false;
};

template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter, std::size_t kNodes, typename Heat>
void NodeProgram<Can, Switches, Counter, kNodes, Heat>::pass() {
  now_ = clock_.now();
  heat_.drive(now_);
  take_inputs();
  if (!bus_news() && !heat_.due(now_) &&
      std::ranges::none_of(nodes_, [&](const Place& n) { return n && n->due(now_); })) {
    // Nothing to do for a node: most passes end here.
    if (!can_.queue().idle()) send();
    return;
  }
  each([&](auto& n) { n.serve(now_); });
  heat_.serve(now_);
  heat_.drive(now_);  // power that was taken does not wait for the next pass
  // Before the answer: who has it may send at once what was asked for.
  filter();
  send();
  report_bus();
  each([](auto& n) { n.find_due(); });
  heat_.find_due();
}

template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter, std::size_t kNodes, typename Heat>
template <typename Tell>
void NodeProgram<Can, Switches, Counter, kNodes, Heat>::tell_each(Tell&& tell) {
  bool told = false;
  for (std::size_t i = 0; i < kNodes; ++i) {
    if (!nodes_[i] || !tell(i, nodes_[i]->node())) continue;
    nodes_[i]->touch();
    told = true;
  }
  if (told) send();
}

// Frames and edges in the order in which they happened.
template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter, std::size_t kNodes, typename Heat>
void NodeProgram<Can, Switches, Counter, kNodes, Heat>::take_inputs() {
  for (int taken = 0; taken < kInputsPerPass; ++taken) {
    const auto* frame = can_.front();
    const SwitchEdge* edge = switches_.front();
    const bool edge_first =
        edge != nullptr && (frame == nullptr || static_cast<std::int32_t>(edge->counts - frame->counts) < 0);
    if (edge_first) {
      on_edge(*edge);
      switches_.drop();
    } else if (frame != nullptr) {
      const CanFrame heard = frame->frame();
      const LocalTime at = clock_.at(frame->counts);
      each([&](auto& n) { n.on_frame(at, heard); });
      heat_.on_frame(at, heard);
      can_.drop();
    } else {
      break;
    }
  }
}

template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter, std::size_t kNodes, typename Heat>
void NodeProgram<Can, Switches, Counter, kNodes, Heat>::on_edge(const SwitchEdge& edge) {
  if (edge.input < kMostInputs) {
    levels_[edge.input] = edge.level;
    known_inputs_ = std::max<std::size_t>(known_inputs_, edge.input + 1u);
  }
  each([&](auto& n) { n.on_switch(clock_.at(edge.counts), edge.input, edge.level); });
  heat_.on_edge(edge.input, edge.level);
}

// In turns, so that none keeps the others from the bus.
template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter, std::size_t kNodes, typename Heat>
void NodeProgram<Can, Switches, Counter, kNodes, Heat>::send() {
  can_.serve_mailboxes();
  constexpr std::size_t kSpeakers = kNodes + Heat::kNodes;
  for (std::size_t silent = 0; silent < kSpeakers; first_ = (first_ + 1) % kSpeakers) {
    if (!can_.queue().has_room()) return;
    const bool heat = first_ == kNodes;
    Place* const speaker = heat ? nullptr : nodes_.data() + first_;
    const auto frame = heat ? heat_.next_frame() : next_frame_of(*speaker);
    if (!frame) {
      ++silent;
      continue;
    }
    silent = 0;
    can_.queue().push(*frame);
    can_.serve_mailboxes();
    for (Place& place : nodes_)
      if (place && &place != speaker) place->on_frame(now_, *frame);
    if (!heat) heat_.on_frame(now_, *frame);
  }
}

template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter, std::size_t kNodes, typename Heat>
void NodeProgram<Can, Switches, Counter, kNodes, Heat>::filter() {
  bool changed = std::exchange(fewer_, false);
  each([&](auto& n) { changed = n.renew_hearing(now_) || changed; });
  changed = heat_.renew_hearing(now_) || changed;
  if (!changed) return;
  std::array<CanAccept, kCanFilters*(kNodes + Heat::kNodes)> all{};
  std::size_t count = 0;
  const auto add = [&](std::span<const CanAccept> wanted) {
    for (const CanAccept& accept : wanted) {
      const auto known = std::span(all).first(count);
      if (std::find(known.begin(), known.end(), accept) == known.end()) all[count++] = accept;
    }
  };
  each([&](const auto& n) { add(n.hearing().accepted()); });
  add(heat_.accepted());
  can_.accept(std::span(all).first(count));
}

template <CanDriver Can, SwitchDriver Switches, LocalCounter Counter, std::size_t kNodes, typename Heat>
void NodeProgram<Can, Switches, Counter, kNodes, Heat>::report_bus() {
  if (!bus_news()) return;
  const CanEvents events = can_.events();
  const bool off = can_.bus_off();
  // Told when the bus can hear it again.
  const bool back = !off && (was_off_ || events.bus_off != told_.bus_off);
  each([&](auto& n) {
    Node& node = n.node();
    if (events.overruns != told_.overruns) {
      node.on_receive_overrun(now_, events.overruns - told_.overruns);
      node.report(emcy::kCanOverrun);
    }
    if (events.passive != told_.passive) node.report(emcy::kErrorPassive);
    if (events.bus_off != told_.bus_off) node.count(NodeCounter::kBusOff, events.bus_off - told_.bus_off);
    if (back) node.report(emcy::kBusOffRecovered);
    n.touch();
  });
  was_off_ = off;
  told_ = events;
}

}  // namespace kinebus
