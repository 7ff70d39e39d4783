#include "node_firmware/core/segment_stream.hpp"

#include <algorithm>

namespace kinebus {
namespace {

constexpr std::size_t index_of(int axis) {
  return static_cast<std::size_t>(axis);
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
  knot_[index_of(axis)] = rest;
  position_[index_of(axis)] = position;
  velocity_[index_of(axis)] = 0;
}

SegmentStream::Verdict SegmentStream::push(std::uint64_t raw, PathTime now) {
  const auto sequence = static_cast<std::uint8_t>(raw & 0x7F);
  if (sequence != next_sequence_) {
    const bool again = any_accepted_ && raw == last_raw_;
    return again ? Verdict::kDuplicate : Verdict::kSequence;
  }
  if (phase_ == Phase::kUnderrun) return Verdict::kNotStarted;
  if (size_ == kCapacity) return Verdict::kOverflow;
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
    next.start_units = next.knot_units = record.start_units;
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
  if (behind > size_) {
    const bool ahead = kSequenceModulus - behind <= kMaxAhead;
    if (!ahead) return Verdict::kStaleCheckpoint;
    pending_[checkpoint.axis] = {true, checkpoint};
    return Verdict::kAccepted;
  }
  // Its record waits in the queue: walk there from the knot that is executed.
  AxisState state = knot_[checkpoint.axis];
  for (int i = 0; i < size_ - behind; ++i) {
    const auto record = decode_segment(records_[index_of((head_ + i) % kCapacity)]);
    if (record && record->duration != 0)
      state =
          advance(state, record->acceleration[checkpoint.axis], record->duration, shift_[checkpoint.axis]);
  }
  return verdict(state);
}

void SegmentStream::clear(PathTime at) {
  advance_to(at);
  for (std::size_t i = 0; i < knot_.size(); ++i) knot_[i] = AxisState{position_[i], 0};
  velocity_ = {};
  tail_ = Tail{.axes = knot_};
  head_ = size_ = 0;
  next_sequence_ = 0;
  any_accepted_ = false;
  pending_ = {};
  phase_ = Phase::kRest;
  in_segment_ = false;
}

bool SegmentStream::advance_to(PathTime at) {
  const std::int64_t ticks = at.count();
  while (step(ticks)) {
  }
  evaluate(ticks);
  return phase_ != Phase::kUnderrun;
}

// One record further when its time has passed; false: nothing more to execute until `ticks`.
bool SegmentStream::step(std::int64_t ticks) {
  if (phase_ == Phase::kRest) {
    if (size_ == 0) return false;
    knot_ticks_ = front().start_units * kPathTicksPerUnit;  // admit() lets only START follow a rest
    phase_ = Phase::kRunning;
    pop();
    return true;
  }
  if (ticks < knot_ticks_ || phase_ == Phase::kUnderrun) return false;
  if (!in_segment_) {
    if (size_ == 0) {
      phase_ = Phase::kUnderrun;
      return false;
    }
    current_ = front();
    if (current_.control == SegmentControl::kEnd) {
      phase_ = Phase::kRest;
      pop();
      return true;
    }
    in_segment_ = true;
  }
  const std::int64_t end = knot_ticks_ + current_.duration * kPathTicksPerUnit;
  if (ticks < end) return false;
  for (std::size_t i = 0; i < knot_.size(); ++i)
    knot_[i] = advance(knot_[i], current_.acceleration[i], current_.duration, shift_[i]);
  knot_ticks_ = end;
  in_segment_ = false;
  pop();
  return true;
}

void SegmentStream::evaluate(std::int64_t ticks) {
  const std::int64_t into = in_segment_ ? std::max<std::int64_t>(ticks - knot_ticks_, 0) : 0;
  for (std::size_t i = 0; i < knot_.size(); ++i) {
    position_[i] =
        in_segment_ ? position_at(knot_[i], current_.acceleration[i], into, shift_[i]) : knot_[i].position;
    velocity_[i] = in_segment_ ? velocity_at(knot_[i], current_.acceleration[i], into, shift_[i]) : 0;
  }
}

void SegmentStream::put(std::uint64_t raw) {
  records_[index_of((head_ + size_) % kCapacity)] = raw;
  ++size_;
  next_sequence_ = static_cast<std::uint8_t>((next_sequence_ + 1) % kSequenceModulus);
  last_raw_ = raw;
  any_accepted_ = true;
}

void SegmentStream::pop() {
  head_ = (head_ + 1) % kCapacity;
  --size_;
  ++consumed_;
}

Segment SegmentStream::front() const {
  return decode_segment(records_[index_of(head_)]).value_or(Segment{});
}

}  // namespace kinebus
