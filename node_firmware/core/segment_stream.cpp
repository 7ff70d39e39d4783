#include "node_firmware/core/segment_stream.hpp"

#include <algorithm>

namespace kinebus {
namespace {

constexpr std::size_t index_of(int axis) {
  return static_cast<std::size_t>(axis);
}

constexpr unsigned sequence_of(std::uint64_t raw) {
  return static_cast<unsigned>(raw & 0x7F);
}

constexpr unsigned early_bit(unsigned sequence) {
  return 1U << (sequence % SegmentStream::kOrderWindow);
}

}  // namespace

void SegmentStream::set_limits(int axis, const Limits& limits) {
  if (!idle()) return;
  // Beyond 2^40 (256 counts a unit) the products of advance() would leave 64 bits.
  constexpr std::int64_t kFastest = std::int64_t{1} << 40;
  Limits& mine = limits_[index_of(axis)];
  mine = limits;
  mine.velocity = std::clamp<std::int64_t>(limits.velocity, 0, kFastest);
}

void SegmentStream::set_shift(int axis, int shift) {
  if (idle()) shift_[index_of(axis)] = std::clamp(shift, 0, kMaxAccelerationShift);
}

void SegmentStream::set_following(int axis, bool following) {
  following_[index_of(axis)] = following;
}

void SegmentStream::set_rest_position(int axis, std::int64_t position) {
  if (!idle()) return;
  const AxisState rest{position, 0};
  tail_.axes[index_of(axis)] = rest;
  run_.knot[index_of(axis)] = rest;
  position_[index_of(axis)] = position;
  velocity_[index_of(axis)] = 0;
}

SegmentStream::Verdict SegmentStream::push(std::uint64_t raw, PathTime now) {
  const unsigned ahead = (sequence_of(raw) - next_sequence_) & (kSequenceModulus - 1);
  if (ahead != 0) return any_accepted_ && raw == last_raw_ ? Verdict::kDuplicate : keep_early(raw, ahead);
  Verdict verdict = take(raw, now);
  while (verdict == Verdict::kAccepted && (early_mask_ & early_bit(next_sequence_)) != 0) {
    early_mask_ &= ~early_bit(next_sequence_);
    ++reordered_;
    verdict = take(early_[next_sequence_ % kOrderWindow], now);
  }
  return verdict;
}

SegmentStream::Verdict SegmentStream::keep_early(std::uint64_t raw, unsigned ahead) {
  if (ahead >= kOrderWindow) return Verdict::kSequence;
  const unsigned sequence = sequence_of(raw);
  std::uint64_t& place = early_[sequence % kOrderWindow];
  if ((early_mask_ & early_bit(sequence)) != 0)
    return place == raw ? Verdict::kDuplicate : Verdict::kSequence;
  place = raw;
  early_mask_ |= early_bit(sequence);
  return Verdict::kEarly;
}

SegmentStream::Verdict SegmentStream::take(std::uint64_t raw, PathTime now) {
  if (run_.phase == Phase::kUnderrun) return Verdict::kNotStarted;
  if (run_.size == kCapacity) return Verdict::kOverflow;
  const auto record = decode_segment(raw);
  if (!record) return Verdict::kUnknown;

  Tail next = tail_;
  const Verdict verdict = admit(*record, now, next);
  if (verdict != Verdict::kAccepted) return verdict;
  tail_ = next;
  put(raw);
  return pending_agree() ? Verdict::kAccepted : Verdict::kCheckpoint;
}

SegmentStream::Verdict SegmentStream::admit(const Segment& record, PathTime now, Tail& next) const {
  if (record.control == SegmentControl::kStart) {
    if (!next.resting) return Verdict::kStartInMotion;
    const bool passed = record.start_units * kPathTicksPerUnit <= now.count();
    if (passed || record.start_units < next.knot_units) return Verdict::kLateStart;
    next.knot_units = record.start_units;
    next.resting = false;
    return Verdict::kAccepted;
  }
  if (next.resting) return Verdict::kNotStarted;
  if (record.control == SegmentControl::kEnd) {
    for (const AxisState& axis : next.axes)
      if (axis.velocity != 0) return Verdict::kEndInMotion;
    next.resting = true;
    return Verdict::kAccepted;
  }
  for (std::size_t i = 0; i < next.axes.size(); ++i) {
    if (record.acceleration[i] != 0 && !following_[i]) return Verdict::kNotFollowing;
    const Limits& limits = limits_[i];
    AxisState& axis = next.axes[i];
    axis = advance(axis, record.acceleration[i], record.duration, shift_[i]);
    if (axis.velocity > limits.velocity || axis.velocity < -limits.velocity) return Verdict::kOutOfLimits;
    if (axis.position > limits.max_position || axis.position < limits.min_position)
      return Verdict::kOutOfLimits;
  }
  next.knot_units += record.duration;
  return Verdict::kAccepted;
}

bool SegmentStream::pending_agree() {
  bool good = true;
  for (Pending& pending : pending_) {
    if (!pending.waiting || pending.checkpoint.sequence != next_sequence_) continue;
    pending.waiting = false;
    good = good && agrees(pending.checkpoint, tail_.axes[pending.checkpoint.axis]);
  }
  return good;
}

SegmentStream::Verdict SegmentStream::check(std::uint64_t raw) {
  const Checkpoint checkpoint = decode_checkpoint(raw);
  const auto verdict = [&](const AxisState& state) {
    return agrees(checkpoint, state) ? Verdict::kAccepted : Verdict::kCheckpoint;
  };
  const int behind = (next_sequence_ - checkpoint.sequence) & (kSequenceModulus - 1);
  if (behind == 0) return verdict(tail_.axes[checkpoint.axis]);
  if (behind > run_.size) {
    const bool ahead = kSequenceModulus - behind <= kMaxAhead;
    if (!ahead) return Verdict::kStaleCheckpoint;
    pending_[checkpoint.axis] = {true, checkpoint};
    return Verdict::kAccepted;
  }
  // Its record waits in the queue: walk there from the knot that is executed.
  AxisState state = run_.knot[checkpoint.axis];
  for (int i = 0; i < run_.size - behind; ++i) {
    // Of duration 0, and so no step: START and END.
    const Segment record =
        decode_segment(records_[index_of((run_.head + i) % kCapacity)]).value_or(Segment{});
    state = advance(state, record.acceleration[checkpoint.axis], record.duration, shift_[checkpoint.axis]);
  }
  return verdict(state);
}

void SegmentStream::clear(PathTime at) {
  advance_to(at);
  for (std::size_t i = 0; i < run_.knot.size(); ++i) run_.knot[i] = AxisState{position_[i], 0};
  velocity_ = {};
  tail_ = Tail{.axes = run_.knot};
  run_.head = run_.size = 0;
  next_sequence_ = 0;
  any_accepted_ = false;
  early_mask_ = 0;
  pending_ = {};
  run_.phase = Phase::kRest;
  run_.in_segment = false;
}

bool SegmentStream::advance_to(PathTime at) {
  const std::int64_t ticks = at.count();
  while (step(run_, ticks)) {
  }
  evaluate(ticks);
  return run_.phase != Phase::kUnderrun;
}

void SegmentStream::Preview::advance_to(PathTime at) {
  ticks_ = at.count();
  while (stream_.step(run_, ticks_)) {
  }
}

// One record further when its time has passed; false: nothing more to execute until `ticks`.
bool SegmentStream::step(Execution& run, std::int64_t ticks) const {
  if (run.phase == Phase::kRest) {
    if (run.size == 0) return false;
    run.knot_ticks = front(run).start_units * kPathTicksPerUnit;  // admit() lets only START follow a rest
    run.phase = Phase::kRunning;
    pop(run);
    return true;
  }
  if (ticks < run.knot_ticks || run.phase == Phase::kUnderrun) return false;
  if (!run.in_segment) {
    if (run.size == 0) {
      run.phase = Phase::kUnderrun;
      return false;
    }
    run.current = front(run);
    if (run.current.control == SegmentControl::kEnd) {
      run.phase = Phase::kRest;
      pop(run);
      return true;
    }
    run.in_segment = true;
  }
  const std::int64_t end = run.knot_ticks + run.current.duration * kPathTicksPerUnit;
  if (ticks < end) return false;
  for (std::size_t i = 0; i < run.knot.size(); ++i)
    run.knot[i] = advance(run.knot[i], run.current.acceleration[i], run.current.duration, shift_[i]);
  run.knot_ticks = end;
  run.in_segment = false;
  pop(run);
  return true;
}

std::int64_t SegmentStream::position_in(const Execution& run, int axis, std::int64_t ticks) const {
  const std::size_t i = index_of(axis);
  if (!run.in_segment) return run.knot[i].position;
  const std::int64_t into = std::max<std::int64_t>(ticks - run.knot_ticks, 0);
  return position_at(run.knot[i], run.current.acceleration[i], into, shift_[i]);
}

void SegmentStream::evaluate(std::int64_t ticks) {
  const std::int64_t into = run_.in_segment ? std::max<std::int64_t>(ticks - run_.knot_ticks, 0) : 0;
  for (std::size_t i = 0; i < velocity_.size(); ++i) {
    position_[i] = position_in(run_, static_cast<int>(i), ticks);
    velocity_[i] =
        run_.in_segment ? velocity_at(run_.knot[i], run_.current.acceleration[i], into, shift_[i]) : 0;
  }
}

void SegmentStream::put(std::uint64_t raw) {
  records_[index_of((run_.head + run_.size) % kCapacity)] = raw;
  ++run_.size;
  next_sequence_ = static_cast<std::uint8_t>((next_sequence_ + 1) % kSequenceModulus);
  last_raw_ = raw;
  any_accepted_ = true;
}

void SegmentStream::pop(Execution& run) {
  run.head = (run.head + 1) % kCapacity;
  --run.size;
  ++run.consumed;
}

Segment SegmentStream::front(const Execution& run) const {
  return decode_segment(records_[index_of(run.head)]).value_or(Segment{});
}

}  // namespace kinebus
