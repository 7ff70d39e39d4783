#pragma once
// One of the nodes of a board: its core, what it wants to hear, and the plan of its motors.

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "node_firmware/board/hearing.hpp"
#include "node_firmware/board/local_clock.hpp"
#include "node_firmware/core/motion_plan.hpp"
#include "node_firmware/core/node.hpp"

namespace kinebus {

/// Which of a node's switch inputs a board's input is, counted from 0; -1: none. Empty: each its own.
using InputPlaces = std::span<const std::int8_t>;

/// What plans are like, and where they begin: on counts that are `phase` modulo `spacing`, a power of two.
/// Where motors are driven by frames, none of these then goes over from one piece of a plan into the next.
struct PlanGrid {
  PlanCounts phase = 0, spacing = 1;
  PlanSize size{};
};

template <LocalCounter Counter>
class BoardNode {
 public:
  BoardNode(const NodeOptions& options, BusClock& bus_clock, const LocalClock<Counter>& clock, LocalTime now,
            std::span<const std::uint8_t> stored, MotionPlanExchange& plan, const PlanGrid& grid,
            InputPlaces inputs)
      : clock_(clock),
        plan_(plan),
        grid_(grid),
        inputs_(inputs),
        node_(told_by_plan(options), bus_clock, now, stored) {
    plan_.renew(node_, now, Counter::counts(), grid.size);
  }

  Node& node() { return node_; }
  const Node& node() const { return node_; }
  const Hearing& hearing() const { return hearing_; }
  bool due(LocalTime now) const { return touched_ || renewed_ || now >= due_; }
  /// Something was told to the node elsewhere.
  void touch() { touched_ = true; }
  std::optional<CanFrame> next_frame() {
    auto frame = node_.next_frame();
    renewed_ = renewed_ || frame;
    return frame;
  }

  /// From the bus, or from another node of the board.
  void on_frame(LocalTime at, const CanFrame& frame) {
    if (!hearing_.hears(frame)) return;
    node_.on_frame(at, frame);
    touched_ = true;
    // At once: the frame may have come after this pass began, and its answer goes out in this pass.
    if (frame.id == cob_id::kSdoRequest + node_.node_id()) hearing_due_ = {};
  }
  void on_switch(LocalTime at, std::uint8_t input, bool level) {
    const int place = inputs_.empty() ? input : inputs_[input];
    if (place < 0) return;
    node_.on_switch(at, place, level);
    touched_ = true;
  }
  /// What is due, and a new plan where it has become another one. Most frames are for one node of a board,
  /// or for none: the others have nothing to find out then.
  void serve(LocalTime now) {
    if (!due(now)) return;
    renewed_ = true;
    bool changed = std::exchange(touched_, false);
    // The inputs have taken a while, in which the motors have gone on.
    const bool stops = node_.stop_waits();
    if (stops || now >= node_.next_deadline()) {
      node_.on_time(stops ? clock_.at(Counter::counts()) : now);
      changed = true;
    }
    // The plan begins now, or where its next frame does, and never before what the node knows.
    const PlanCounts at_once = Counter::counts();
    const PlanCounts counts = at_once + ((grid_.phase - at_once) & (grid_.spacing - 1));
    const LocalTime from = clock_.at(counts);
    if (now >= plan_due_ || stops || (changed && plan_.outdated(node_, from, counts))) {
      plan_.renew(node_, from, counts, grid_.size);
      plan_due_ = now + kPlanCount * MotionPlan::horizon(grid_.size.fresh);
    }
  }
  /// True: what is heard has changed.
  bool renew_hearing(LocalTime now) {
    if (now < hearing_due_) return false;
    hearing_due_ = now + kHearingPeriod;
    return hearing_.renew(node_);
  }
  /// After the frames that the node has to say were taken.
  void find_due() {
    if (std::exchange(renewed_, false)) due_ = std::min({node_.next_deadline(), plan_due_, hearing_due_});
  }

 private:
  static NodeOptions told_by_plan(NodeOptions options) {
    options.stops_on_time = true;
    return options;
  }

  static constexpr LocalTime kHearingPeriod = std::chrono::milliseconds{10};

  const LocalClock<Counter>& clock_;
  MotionPlanExchange& plan_;
  const PlanGrid& grid_;
  InputPlaces inputs_;
  Node node_;
  Hearing hearing_;
  LocalTime due_{0}, plan_due_{0}, hearing_due_{0};
  bool touched_ = true;
  bool renewed_ = false;  ///< or was served: what is due next is not known
};

}  // namespace kinebus
