#include "node_firmware/core/motion_plan.hpp"

#include "node_firmware/core/node.hpp"

namespace kinebus {

void MotionPlanExchange::renew(const Node& node, LocalTime now, PlanCounts counts) {
  const std::uint32_t next = 1 - current_.load(std::memory_order_relaxed);
  MotionPlan& plan = plans_[next];
  plan.start = counts;
  NodePreview preview(node);
  constexpr LocalTime kHalf = kPlanCount * (MotionPlan::kPiece / 2);
  LatchedPositions from = preview.positions(now);
  for (std::size_t piece = 0; piece < MotionPlan::kPieces; ++piece) {
    const LatchedPositions middle = preview.positions(now += kHalf);
    const LatchedPositions to = preview.positions(now += kHalf);
    for (std::size_t axis = 0; axis < from.size(); ++axis)
      plan.pieces[axis][piece] = MotionPlan::through(from[axis], middle[axis], to[axis]);
    from = to;
  }
  current_.store(next, std::memory_order_release);
}

}  // namespace kinebus
