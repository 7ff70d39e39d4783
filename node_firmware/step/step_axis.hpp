#pragma once
// The steps of one axis: as many as bring the motor to the whole step that is nearest to the plan, in each
// slot of a microsecond. The number is exact in every slot (to kTolerance), but that two steps keep their
// distance (kSpacing): where the plan crosses one place to and fro faster than that, the second step comes
// late by the rest of it, and none is lost.
//
// Within a frame the plan is a parabola, walked by its differences in words of 32 bits. Every frame begins
// anew from the plan, so that what is rounded in one is not in the next.

#include <array>
#include <cstdint>

#include "node_firmware/core/motion_plan.hpp"
#include "node_firmware/step/step_frame.hpp"

namespace kinebus::step {

/// The plan over a frame, in counts with 32 fractional bits: from + slope * u + bend * u^2, where u goes from
/// 0 to 1, and 0 is kSetUp slots after the frame's first slot.
struct PlannedWay {
  std::int64_t from = 0, slope = 0, bend = 0;

  std::int64_t to() const { return from + slope + bend; }
  static PlannedWay through(std::int64_t from, std::int64_t middle, std::int64_t to) {
    const MotionPlan::Parabola p = MotionPlan::through(from, middle, to);
    return {p.position, p.first, p.second};
  }
};
inline PlannedWay planned_way(const MotionPlan& plan, int axis, PlanCounts frame) {
  const PlanCounts begin = frame + kSetUp * kSlotCounts;
  const PlanCounts elapsed = begin - plan.start, into = elapsed % MotionPlan::kPiece;
  if (elapsed < plan.horizon() && into + kFrameCounts <= MotionPlan::kPiece) [[likely]] {
    // Within a piece: a part of its parabola is one, too.
    constexpr int kFramesBits = MotionPlan::kPieceBits - kFrameBits;
    const auto& piece =
        plan.pieces[static_cast<std::size_t>(axis)][std::size_t{elapsed >> MotionPlan::kPieceBits}];
    const MotionPlan::Point point = MotionPlan::evaluate(piece, into);
    return {point.position, point.velocity >> kFramesBits, piece.second >> (2 * kFramesBits)};
  }
  return PlannedWay::through(plan.at(axis, begin).position, plan.at(axis, begin + kFrameCounts / 2).position,
                             plan.at(axis, begin + kFrameCounts).position);
}

/// A step is 2^kStepBits counts: 4 where a full step of 256 counts is 16 microsteps. kQuickDivision: the
/// processor has an instruction for it.
template <int kStepBits, bool kQuickDivision = true>
class StepAxis {
 public:
  /// So far, in counts, what is walked may be from the parabola at a frame's end, where it is most: rounded
  /// differences, 2^-17, and the 2^-24 of each of the 64 sums.
  static constexpr double kTolerance = 1.6e-5 * (1 << kStepBits) / 16;

  /// The steps of the next frame, in order: put.step(slot), or put.early_step(slot) where the slot is before
  /// kEarly, each to begin kSetUp after its slot, and before it put.turn(slot, up), if the direction is to be
  /// set in that slot; up: towards positive counts. False: the plan is farther ahead than steps can follow;
  /// when a frame begins so, none are made.
  template <typename Put>
  bool fill(const PlannedWay& way, Put&& put);
  /// Without power: the number goes with the plan, and no step is made.
  void follow(const PlannedWay& way);

  /// Steps from where the motor was at power-up, those of the last frame included.
  std::int32_t steps() const { return steps_; }
  /// In the last frame.
  bool moved() const { return made_ != 0; }
  /// The next step sets its direction, whatever the last one was.
  void forget_direction() { direction_ = Direction::kUnknown; }

 private:
  static constexpr int kStepShift = 32 + kStepBits;
  static constexpr std::int64_t kStep = std::int64_t{1} << kStepShift;
  // Within a frame a step is 2^28, so that 8 of them fit into a word; differences have kFine bits more.
  static constexpr int kPlaceBits = 28, kFine = 4;
  static constexpr std::int32_t kWhole = std::int32_t{1} << kPlaceBits;
  static constexpr int kPlaceShift = kStepShift - kPlaceBits;
  static_assert(kSlots == 64 && kPlaceShift >= kFine);
  /// A plan that is so many steps ahead at the end of a frame is none that speed can explain.
  static constexpr std::int32_t kMostBehind = 4;
  // With these, no sum leaves its word: at most 6 steps to begin with and 4 more than can be made at the end,
  // by a velocity of less than half a step in a slot.
  static constexpr std::int64_t kMostAhead = kStep * (kMostBehind + 2);
  static constexpr std::int64_t kMostWay = kStep * (kSlots / kSpacing + kMostBehind);
  static constexpr std::int64_t kMostBend = kStep * 4;
  enum class Direction : std::uint8_t { kUnknown, kUp, kDown };

  /// Through a frame: the place above the lower border of the present step, and its differences.
  struct Walk {
    std::int32_t place = 0, velocity = 0, change = 0;
    int slot = 0;

    [[gnu::always_inline]] void go_on(int slots) {
      place += slots * (velocity >> kFine) + (slots * (slots - 1) / 2 * change >> kFine);
      velocity += slots * change;
      slot += slots;
    }
  };
  /// Never turns. Upwards; the number of steps.
  template <typename Put>
  int one_way(Walk& walk, Direction direction, Put& put);
  template <typename Put>
  void to_and_fro(Walk& walk, Put& put);

  static bool within(std::int64_t value, std::int64_t most) { return value <= most && value >= -most; }

  std::int32_t steps_ = 0;
  int made_ = 0;
  int free_from_ = 0;  ///< the first slot of the next frame that may have a step
  Direction direction_ = Direction::kUnknown;
};

template <int kStepBits, bool kQuickDivision>
void StepAxis<kStepBits, kQuickDivision>::follow(const PlannedWay& way) {
  steps_ = static_cast<std::int32_t>((way.to() + kStep / 2) >> kStepShift);
  free_from_ = made_ = 0;
}

// Inlined with what it calls: in a control interrupt all of it is to stay in registers.
template <int kStepBits, bool kQuickDivision>
template <typename Put>
[[gnu::always_inline]] inline bool StepAxis<kStepBits, kQuickDivision>::fill(const PlannedWay& way,
                                                                             Put&& put) {
  made_ = 0;
  // The place above the lower border of the present step.
  const std::int64_t from = way.from - (static_cast<std::int64_t>(steps_) * kStep - kStep / 2);
  if ((way.slope | way.bend) == 0 && (from >> kStepShift) == 0) {
    free_from_ = 0;
    return true;  // at rest
  }
  const std::int64_t to = from + way.slope + way.bend;
  if (!within(from, kMostAhead) || !within(to, kMostWay) || !within(way.bend, kMostBend)) return false;

  Walk walk{
      .place = static_cast<std::int32_t>(from >> kPlaceShift),
      .velocity = static_cast<std::int32_t>((way.slope * kSlots + way.bend) >> (12 + kPlaceShift - kFine)),
      .change = static_cast<std::int32_t>(((way.bend >> (10 + kPlaceShift - kFine)) + 1) >> 1)};
  const int first = free_from_;
  free_from_ = 0;
  if (within(way.slope, kStep) && within(way.bend, kStep)) {
    // Off its chord the parabola is by a quarter of the bend at most.
    const auto end = static_cast<std::int32_t>(to >> kPlaceShift);
    const auto bend = static_cast<std::int32_t>(way.bend >> kPlaceShift);
    const std::int32_t off = (bend < 0 ? -bend : bend) / 4 + 2;
    if ((walk.place < end ? walk.place : end) >= off && (walk.place < end ? end : walk.place) + off < kWhole)
      return true;
  }
  walk.go_on(first);
  const std::int32_t last = walk.velocity + (kSlots - first) * walk.change;
  const bool up = walk.velocity >= 0 && last >= 0 && walk.place >= 0;
  if (up || (walk.velocity <= 0 && last <= 0 && walk.place < kWhole)) {
    if (!up) {
      // The same upside down.
      walk.place = kWhole - 1 - walk.place;
      walk.velocity = -walk.velocity;
      walk.change = -walk.change;
    }
    const int made = one_way(walk, up ? Direction::kUp : Direction::kDown, put);
    steps_ += up ? made : -made;
  } else {
    to_and_fro(walk, put);
  }
  return walk.place < (kMostBehind + 1) * kWhole && walk.place >= -kMostBehind * kWhole;
}

template <int kStepBits, bool kQuickDivision>
template <typename Put>
[[gnu::always_inline]] inline int StepAxis<kStepBits, kQuickDivision>::one_way(Walk& walk,
                                                                               Direction direction,
                                                                               Put& put) {
  // A slow axis goes at once as far as it certainly makes no step: the way to the border by the fastest that
  // it is in this frame. A division of words: 12 cycles at most.
  const std::int32_t last = walk.velocity + (kSlots - walk.slot) * walk.change;
  const std::int32_t fastest = ((walk.velocity > last ? walk.velocity : last) >> kFine) + 1;
  // Of a faster one a step is so near that looking at each slot takes less.
  constexpr std::int32_t kSlow = kWhole / 16, kEven = kWhole / 1024;
  const bool slow = (fastest < kSlow) && (walk.change < kEven) && (walk.change > -kEven);
  int made = 0;
  std::int32_t place = walk.place, velocity = walk.velocity;
  const std::int32_t change = walk.change;
  // What is left over by a step is less than the way of a slot, unless the axis is behind: then as many slots
  // are passed over as the next step certainly takes. Up to half a frame, so that no product leaves its word.
  // A slow axis divides anyway: one division more is too much where each takes long.
  int stride = kSpacing;
  if ((kQuickDivision || !slow) && place - kWhole < fastest && fastest < kWhole / kSpacing) {
    stride = kWhole / fastest;
    if (stride > kSlots / 2) stride = kSlots / 2;
  }
  const std::int32_t skipped = (stride * (stride - 1) / 2 * change >> kFine) - kWhole;
  int slot = walk.slot;
  const auto step = [&](bool early) __attribute__((always_inline)) {
    early ? put.early_step(slot) : put.step(slot);
    ++made;
    place += stride * (velocity >> kFine) + skipped;
    velocity += stride * change;
    slot += stride;
  };
  if (slow) {
    while (slot < kSlots) {
      if (place >= kWhole) {
        if (made == 0 && direction_ != direction) put.turn(slot, direction == Direction::kUp);
        step(false);
        continue;
      }
      int slots = (kWhole - 1 - place) / fastest;
      slots = slots > kSlots - slot ? kSlots - slot : slots < 1 ? 1 : slots;
      place += slots * (velocity >> kFine) + (slots * (slots - 1) / 2 * change >> kFine);
      velocity += slots * change;
      slot += slots;
    }
  } else {
    const auto look = [&]() __attribute__((always_inline)) {
      while (place < kWhole && slot < kSlots) {
        place += velocity >> kFine;
        velocity += change;
        ++slot;
      }
    };
    look();
    if (slot < kSlots && direction_ != direction) put.turn(slot, direction == Direction::kUp);
    while (slot < kEarly) {
      step(true);
      look();
    }
    while (slot < kSlots) {
      step(false);
      look();
    }
  }
  if (made != 0) {
    direction_ = direction;
    made_ = made;
    // Only a step leaves a frame so far behind; it was the last thing in it then.
    const int free = slot - stride + kSpacing;
    if (free > kSlots) free_from_ = free - kSlots;
  }
  walk.place = place;
  return made;
}

// Turning within the frame, or before it: step by step.
template <int kStepBits, bool kQuickDivision>
template <typename Put>
[[gnu::noinline]] void StepAxis<kStepBits, kQuickDivision>::to_and_fro(Walk& walk, Put& put) {
  while (walk.slot < kSlots) {
    if (static_cast<std::uint32_t>(walk.place) < static_cast<std::uint32_t>(kWhole)) {
      walk.go_on(1);
      continue;
    }
    const bool up = walk.place >= 0;
    const Direction wanted = up ? Direction::kUp : Direction::kDown;
    if (wanted != direction_) put.turn(walk.slot, up);
    put.step(walk.slot);
    ++made_;
    direction_ = wanted;
    steps_ += up ? 1 : -1;
    walk.place -= up ? kWhole : -kWhole;
    walk.go_on(kSpacing);
    if (walk.slot > kSlots) free_from_ = walk.slot - kSlots;
  }
}

}  // namespace kinebus::step
