#pragma once
// The steps of one axis: as many as bring the motor to the whole step that is nearest to the plan, in each
// slot of a microsecond. The number is exact in every slot, but that two steps keep their distance
// (kSpacing): where the plan crosses one place to and fro faster than that, the second step comes late by the
// rest of it, and none is lost.
//
// Within a frame the plan is the parabola through three of its points, walked in exact integers.

#include <array>
#include <cstdint>

#include "node_firmware/core/motion_plan.hpp"
#include "node_firmware/step/step_frame.hpp"

namespace kinebus::step {

/// The plan in counts with 32 fractional bits: kSetUp slots after the frame's first slot, half a frame
/// later and a frame later.
struct PlannedWay {
  std::int64_t from = 0, middle = 0, to = 0;
};
inline PlannedWay planned_way(const MotionPlan& plan, int axis, PlanCounts frame) {
  constexpr PlanCounts kAhead = kSetUp * kSlotCounts;
  return {plan.at(axis, frame + kAhead).position, plan.at(axis, frame + kAhead + kFrameCounts / 2).position,
          plan.at(axis, frame + kAhead + kFrameCounts).position};
}
/// What happens in a frame, in slots of it; a step begins kSetUp after its slot.
struct StepEvent {
  std::uint8_t slot = 0;
  bool up = false;      ///< towards positive counts
  bool turned = false;  ///< the direction is to be set in this slot
};
struct StepEvents {
  std::array<StepEvent, kSlots / kSpacing> list{};
  std::size_t count = 0;
};

/// A step is 2^kStepBits counts: 4 where a full step of 256 counts is 16 microsteps.
template <int kStepBits>
class StepAxis {
 public:
  /// The steps of the next frame. False: the plan is farther ahead than steps can follow; none are made then.
  bool fill(const PlannedWay& way, StepEvents& events);
  /// Without power: the number goes with the plan, and no step is made.
  void follow(const PlannedWay& way);

  /// Steps from where the motor was at power-up, those of the last frame included.
  std::int32_t steps() const { return steps_; }
  /// The next step sets its direction, whatever the last one was.
  void forget_direction() { direction_ = Direction::kUnknown; }

 private:
  static constexpr int kStepShift = 32 + kStepBits;
  static constexpr std::int64_t kStep = std::int64_t{1} << kStepShift;
  // Within a frame: counts with 44 fractional bits, so that a 64th of the frame's first difference and a
  // 4096th of its second are whole.
  static constexpr int kFine = 12;
  /// A plan that is so many steps ahead at the end of a frame is none that speed can explain.
  static constexpr std::int64_t kMostBehind = 4;
  enum class Direction : std::uint8_t { kUnknown, kUp, kDown };

  std::int32_t steps_ = 0;
  int free_from_ = 0;  ///< the first slot of the next frame that may have a step
  Direction direction_ = Direction::kUnknown;
};

template <int kStepBits>
void StepAxis<kStepBits>::follow(const PlannedWay& way) {
  steps_ = static_cast<std::int32_t>((way.to + kStep / 2) >> kStepShift);
  free_from_ = 0;
}

template <int kStepBits>
bool StepAxis<kStepBits>::fill(const PlannedWay& way, StepEvents& events) {
  events.count = 0;
  const auto magnitude = [](std::int64_t value) { return value < 0 ? -value : value; };
  const std::int64_t origin = static_cast<std::int64_t>(steps_) * kStep - kStep / 2;
  const std::int64_t from = way.from - origin, to = way.to - origin;
  // Of a frame, all steps that fit into it, and those that it may leave to the next.
  constexpr std::int64_t kMost = kStep * (kSlots / kSpacing + kMostBehind);
  const std::int64_t bend = 2 * (way.from + way.to) - 4 * way.middle;
  if (from > kMost || from < -kMost || to > kMost || to < -kMost || magnitude(bend) > kMost) return false;

  int free = free_from_;
  free_from_ = 0;
  // Off its chord the parabola is by a quarter of the bend at most.
  const std::int64_t off = magnitude(bend) / 4 + 1;
  const std::int64_t low = (from < to ? from : to) - off, high = (from < to ? to : from) + off;
  if (low >= 0 && high < kStep) return true;

  const std::int64_t slope = 4 * (way.middle - way.from) - (way.to - way.from);
  // The place above the lower border of the present step: at slot k from + slope * u + bend * u^2, u = k
  // / 64. Borders have no fraction in the lower word: the upper one decides.
  std::int64_t place = from << kFine;
  std::int64_t velocity = slope * 64 + bend;
  const std::int64_t acceleration = 2 * bend;
  constexpr std::int64_t kWhole = kStep << kFine;
  constexpr std::uint32_t kWidth = std::uint32_t{1} << (kStepBits + kFine);
  for (int slot = 0; slot < kSlots; ++slot) {
    if (static_cast<std::uint32_t>(place >> 32) >= kWidth && slot >= free) [[unlikely]] {
      const bool up = place >= 0;
      const Direction direction = up ? Direction::kUp : Direction::kDown;
      events.list[events.count++] = {static_cast<std::uint8_t>(slot), up, direction != direction_};
      direction_ = direction;
      steps_ += up ? 1 : -1;
      place -= up ? kWhole : -kWhole;
      free = slot + kSpacing;
    }
    place += velocity;
    velocity += acceleration;
  }
  free_from_ = free > kSlots ? free - kSlots : 0;
  constexpr std::int64_t kBehind = kMostBehind * kWhole;
  return place < kWhole + kBehind && place >= -kBehind;
}

}  // namespace kinebus::step
