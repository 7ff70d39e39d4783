#pragma once
// The streamed motion of a node: the queue of records, where its end will be, and where the axes are at a
// path time. Records are checked when they come, by walking the exact state at the end of the queue along
// with them, so a wrong record is refused before it can move anything. Evaluation is on demand and walks over
// elapsed segments.

#include <array>
#include <cstdint>

#include "protocol/motion/segment.hpp"
#include "protocol/motion/tail_check.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class SegmentStream {
 public:
  static constexpr int kCapacity = 120;
  /// Checkpoints may run ahead of their record by so many: 128 sequence numbers less a full queue, less one.
  static constexpr int kMaxAhead = kSequenceModulus - kCapacity - 1;
  /// So many records that come one after another may be in any order: adapters and drivers exchange
  /// neighbours.
  static constexpr unsigned kOrderWindow = 4;

  enum class Verdict : std::uint8_t {
    kAccepted,
    kEarly,            ///< kept until the records before it have come
    kDuplicate,        ///< the record accepted last, or one that is kept, came again: ignored
    kSequence,         ///< a record is missing
    kOverflow,         ///< more than the credit
    kUnknown,          ///< control record of unknown kind
    kLateStart,        ///< START names a path time that has passed, or one before the last END
    kStartInMotion,    ///< START without an END before it
    kNotStarted,       ///< a segment or END without START
    kEndInMotion,      ///< END at a knot with velocity
    kNotFollowing,     ///< the segment moves an axis that does not follow the stream
    kOutOfLimits,      ///< the segment would leave the velocity or position limits
    kCheckpoint,       ///< an absolute checkpoint differs
    kStaleCheckpoint,  ///< its record is executed already: it says nothing any more
  };

  /// Per axis. `velocity`: counts per unit, 32 fractional bits. Positions: 32 fractional bits.
  struct Limits {
    std::int64_t velocity = std::int64_t{1} << 40;
    std::int64_t min_position = -(std::int64_t{1} << 62);
    std::int64_t max_position = std::int64_t{1} << 62;
  };

  // Only while idle() (asserted by ignoring the call otherwise).
  void set_limits(int axis, const Limits& limits);
  void set_shift(int axis, int shift);
  void set_rest_position(int axis, std::int64_t position);

  /// Whether the axis executes what the stream says; one that does not may only be told to rest.
  void set_following(int axis, bool following);
  bool following(int axis) const { return following_[static_cast<std::size_t>(axis)]; }

  /// A record from the bus; `now`: path time now. Only kAccepted changes the queue; what was kept early
  /// follows then, and the verdict is that of the last.
  Verdict push(std::uint64_t raw, PathTime now);
  /// Records are kept for which an earlier one has not come.
  bool waits_for_order() const { return early_mask_ != 0; }
  void forget_early() { early_mask_ = 0; }
  /// Records that came early and were put in their place, since power-up.
  std::uint32_t reordered() const { return reordered_; }
  /// A checkpoint from the bus: kAccepted (agrees, or waits for its record), kCheckpoint or kStaleCheckpoint.
  /// A waiting one is compared by the push() of the record before its own, which then returns kCheckpoint.
  Verdict check(std::uint64_t raw);
  /// Everything queued is dropped; the axes rest where they are at `at`; sequence numbers start again at 0.
  /// Only when path time stands still.
  void clear(PathTime at);

  /// Walks to `at` (never backwards). False: the queue ran out in motion, the axes were held at the last
  /// knot.
  bool advance_to(PathTime at);
  /// At the path time of the last advance_to(), or, within the segment of that time, at a later one.
  std::int64_t position(int axis) const { return position_[static_cast<std::size_t>(axis)]; }
  std::int64_t velocity(int axis) const { return velocity_[static_cast<std::size_t>(axis)]; }

  bool idle() const { return run_.phase == Phase::kRest && run_.size == 0; }
  bool moving() const { return run_.phase == Phase::kRunning && run_.in_segment; }
  bool resting() const { return run_.phase == Phase::kRest; }
  /// Motion without END is queued: it must be followed by more before horizon().
  bool open() const { return !tail_.resting; }
  PathTime horizon() const { return PathTime{tail_.knot_units * kPathTicksPerUnit}; }
  const AxisState& tail_state(int axis) const { return tail_.axes[static_cast<std::size_t>(axis)]; }
  std::uint8_t next_sequence() const { return next_sequence_; }
  /// What the queue comes to, in 8 bits, for who has sent it.
  std::uint8_t tail_check(std::int64_t path_units) const {
    return kinebus::tail_check(next_sequence_, tail_.axes, tail_.knot_units, path_units);
  }
  int free_records() const { return kCapacity - run_.size; }
  int size() const { return run_.size; }
  std::uint32_t consumed() const { return run_.consumed; }  ///< records executed since power-up
  /// Looks ahead of the execution and leaves it as it is: where the axes will be if nothing more comes.
  class Preview;

  /// Ran out of records in motion: everything is refused until clear().
  bool underrun() const { return run_.phase == Phase::kUnderrun; }

 private:
  enum class Phase : std::uint8_t { kRest, kRunning, kUnderrun };
  // The executed end: exact state at the last knot, the segment that follows it when there is one, and the
  // records that wait.
  struct Execution {
    Phase phase = Phase::kRest;
    bool in_segment = false;
    int head = 0;
    int size = 0;
    std::uint32_t consumed = 0;
    std::array<AxisState, kAxesPerNode> knot{};
    std::int64_t knot_ticks = 0;
    Segment current;
  };
  struct Tail {
    std::array<AxisState, kAxesPerNode> axes{};
    std::int64_t knot_units = 0;
    bool resting = true;
  };
  struct Pending {
    bool waiting = false;
    Checkpoint checkpoint;
  };

  Verdict keep_early(std::uint64_t raw, unsigned ahead);
  Verdict take(std::uint64_t raw, PathTime now);
  Verdict admit(const Segment& record, PathTime now, Tail& next) const;
  bool pending_agree();
  void put(std::uint64_t raw);
  static void pop(Execution& run);
  Segment front(const Execution& run) const;
  bool step(Execution& run, std::int64_t ticks) const;
  std::int64_t position_in(const Execution& run, int axis, std::int64_t ticks) const;
  void evaluate(std::int64_t ticks);

  std::array<std::uint64_t, kCapacity> records_{};
  std::array<int, kAxesPerNode> shift_{kDefaultAccelerationShift, kDefaultAccelerationShift};
  std::array<bool, kAxesPerNode> following_{};
  std::uint8_t next_sequence_ = 0;
  bool any_accepted_ = false;
  std::uint64_t last_raw_ = 0;
  std::array<std::uint64_t, kOrderWindow> early_{};  // by sequence; early_mask_: which are there
  unsigned early_mask_ = 0;
  std::uint32_t reordered_ = 0;
  Tail tail_;
  std::array<Pending, kAxesPerNode> pending_{};
  std::array<Limits, kAxesPerNode> limits_{};

  Execution run_;
  std::array<std::int64_t, kAxesPerNode> position_{};
  std::array<std::int64_t, kAxesPerNode> velocity_{};
};

/// Valid until the stream changes.
class SegmentStream::Preview {
 public:
  explicit Preview(const SegmentStream& stream) : stream_(stream), run_(stream.run_) {}
  /// In order of time; the same bits that the stream's own advance_to() and position() would give.
  void advance_to(PathTime at);
  std::int64_t position(int axis) const { return stream_.position_in(run_, axis, ticks_); }

 private:
  const SegmentStream& stream_;
  Execution run_;
  std::int64_t ticks_ = 0;
};

}  // namespace kinebus
