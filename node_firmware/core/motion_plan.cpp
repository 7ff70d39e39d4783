#include "node_firmware/core/motion_plan.hpp"

#include "node_firmware/core/node.hpp"

namespace kinebus {

bool MotionPlanExchange::outdated(const Node& node, LocalTime now, PlanCounts counts) const {
  constexpr std::int64_t kSame = std::int64_t{1} << 26;  // 1/64 count
  const MotionPlan& plan = current();
  const PlanCounts elapsed = counts - plan.start;
  if (elapsed >= plan.horizon()) return true;
  const PlanCounts left = plan.horizon() - elapsed;
  NodePreview preview(node, plan.axes);
  for (const PlanCounts ahead : {left / 2, left}) {
    const LatchedPositions positions = preview.positions(now + kPlanCount * ahead);
    for (int axis = 0; axis < static_cast<int>(plan.axes); ++axis) {
      const std::int64_t off =
          positions[static_cast<std::size_t>(axis)] - plan.at(axis, counts + ahead).position;
      if (off > kSame || off < -kSame) return true;
    }
  }
  return false;
}

void MotionPlanExchange::renew(const Node& node, LocalTime now, PlanCounts counts, const PlanSize& size) {
  const std::uint32_t next = 1 - current_.load(std::memory_order_relaxed);
  MotionPlan& plan = plans_[next];
  plan.start = counts;
  plan.count = size.pieces;
  plan.axes = size.axes;
  NodePreview preview(node, plan.axes);
  constexpr LocalTime kHalf = kPlanCount * (MotionPlan::kPiece / 2);
  LatchedPositions from = preview.positions(now);
  for (std::size_t piece = 0; piece < plan.count; ++piece) {
    const LatchedPositions middle = preview.positions(now += kHalf);
    const LatchedPositions to = preview.positions(now += kHalf);
    for (std::size_t axis = 0; axis < plan.axes; ++axis)
      plan.pieces[axis][piece] = MotionPlan::through(from[axis], middle[axis], to[axis]);
    from = to;
  }
  current_.store(next, std::memory_order_release);
}

}  // namespace kinebus
