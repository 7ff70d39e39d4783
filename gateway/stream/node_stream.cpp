#include "gateway/stream/node_stream.hpp"

#include <algorithm>
#include <cassert>

#include "protocol/motion/tail_check.hpp"

namespace kinebus {

namespace {
constexpr std::uint32_t kSegmentCobId = 0x400;     // RPDO3 of node n
constexpr std::uint32_t kCheckpointCobId = 0x500;  // RPDO4
constexpr std::uint8_t kBothAxes = 0b11;

CanFrame frame_of(std::uint32_t id, std::uint64_t raw) {
  CanFrame frame{.id = id, .length = 8};
  put_u64_le(frame.data, raw);
  return frame;
}

std::int64_t floor_units(PathTime tau) {
  return tau.count() >> 8;
}
}  // namespace

NodeStream::NodeStream(std::uint8_t node_id, Options options)
    : node_id_(node_id), options_(options), records_(kCapacity) {}

void NodeStream::reset(const std::array<AxisState, kAxesPerNode>& states, std::uint8_t next_sequence,
                       std::uint8_t free_records) {
  begin_ = accepted_ = sent_ = end_ = next_sequence;
  credit_ =
      accepted_ + std::min<std::uint64_t>(free_records, static_cast<std::uint64_t>(options_.queue_records));
  if (last_status_) last_status_->free_records = free_records;
  open_ = false;
  tail_units_ = 0;
  tail_ = states;
  for (AxisState& state : tail_) state.velocity = 0;
}

void NodeStream::append(Record record) {
  assert(end_ - begin_ < kCapacity);
  if (end_ >= next_checkpoint_ && record.control == SegmentControl::kNone) {
    record.checkpoints |= static_cast<std::uint8_t>(1u << checkpoint_axis_);
    checkpoint_axis_ ^= 1;
    next_checkpoint_ = end_ + static_cast<std::uint64_t>(options_.checkpoint_interval);
  }
  at(end_++) = record;
}

void NodeStream::push_start() {
  assert(!open_);
  open_ = true;
  released_ = end_;
  run_start_units_ = tail_units_ = 0;
  append({.start = tail_, .control = SegmentControl::kStart});
}

void NodeStream::push(const FittedSegment& segment) {
  Record record{.start_units = run_start_units_ + segment.start_units,
                .duration = segment.duration,
                .acceleration = segment.acceleration,
                .start = segment.start,
                .line = segment.line};
  if (at(end_ - 1).control == SegmentControl::kStart) {
    record.checkpoints = kBothAxes;
    next_checkpoint_ = end_ + static_cast<std::uint64_t>(options_.checkpoint_interval);
  }
  append(record);
  for (std::size_t i = 0; i < tail_.size(); ++i)
    tail_[i] =
        advance(segment.start[i], segment.acceleration[i], segment.duration, options_.acceleration_shift);
  tail_units_ = record.start_units + segment.duration;
}

void NodeStream::push_end() {
  assert(tail_[0].velocity == 0 && tail_[1].velocity == 0);
  append({.start_units = tail_units_, .start = tail_, .control = SegmentControl::kEnd});
}

void NodeStream::release(std::int64_t start_units) {
  assert(open_);
  for (std::uint64_t n = released_; n < end_; ++n) at(n).start_units += start_units;
  run_start_units_ = start_units;
  tail_units_ += start_units;
  open_ = false;
}

std::optional<CanFrame> NodeStream::next_frame(BusTime now, PathTime tau) {
  if (!has_frame(tau)) return std::nullopt;
  const Record& record = at(sent_);
  const auto sequence = static_cast<std::uint8_t>(sent_ % kSequenceModulus);
  const std::uint8_t due = record.checkpoints & static_cast<std::uint8_t>(~checkpoints_sent_);
  if (due != 0) {
    const std::uint8_t axis = (due & 1u) != 0 ? 0 : 1;
    checkpoints_sent_ |= static_cast<std::uint8_t>(1u << axis);
    ++counters_.checkpoints;
    return frame_of(kCheckpointCobId + node_id_,
                    encode(Checkpoint{sequence, axis, record.start[axis].position}));
  }
  if (accepted_ == sent_) progress_ = now;
  ++sent_;
  checkpoints_sent_ = 0;
  ++counters_.records;
  Segment segment{.sequence = sequence,
                  .duration = static_cast<std::uint16_t>(record.duration),
                  .acceleration = record.acceleration,
                  .control = record.control};
  if (record.control == SegmentControl::kStart) segment.start_units = record.start_units;
  return frame_of(kSegmentCobId + node_id_, encode(segment));
}

Result<void, StreamError> NodeStream::on_status(BusTime now, const StreamStatus& status, PathTime tau) {
  ++counters_.statuses;
  StreamError error{.node_id = node_id_};
  const auto known = static_cast<std::uint8_t>(accepted_ % kSequenceModulus);
  const int behind = (known - status.next_sequence) & (kSequenceModulus - 1);
  if (behind != 0 && behind <= kMaxOvertaken && accepted_ >= static_cast<std::uint64_t>(behind))
    return silence(now, tau);  // overtaken on its way by the one that is known
  last_status_ = status;
  const std::uint64_t accepted = accepted_ + static_cast<std::uint8_t>((status.next_sequence - known) & 0x7F);
  if (accepted > sent_) {
    error.kind = StreamError::Kind::kUnknownRecord;
    error.amount = status.next_sequence;
    return Error<StreamError>(error);
  }
  if (accepted > accepted_) progress_ = now;
  accepted_ = accepted;
  credit_ = accepted_ +
            std::min<std::uint64_t>(status.free_records, static_cast<std::uint64_t>(options_.queue_records));
  const std::int64_t here = floor_units(tau), node = status.path_near(here);
  const bool as_sent = agrees(status, node);
  forget_before(std::min(here, node));  // what both have passed

  if ((status.flags & StreamStatus::kSequenceError) != 0) {
    error.kind = StreamError::Kind::kSequence;
    error.amount = status.next_sequence;
  } else if ((status.flags & StreamStatus::kCheckpointError) != 0) {
    error.kind = StreamError::Kind::kCheckpoint;
  } else if ((status.flags & StreamStatus::kUnderrun) != 0) {
    error.kind = StreamError::Kind::kUnderrun;
  } else if (!as_sent) {
    error.kind = StreamError::Kind::kTakenOtherwise;
  } else {
    return silence(now, tau);
  }
  error.line = line_at(tau);
  return Error<StreamError>(error);
}

bool NodeStream::agrees(const StreamStatus& status, std::int64_t path_units) const {
  // Behind the last record that is kept all is executed, or nothing was sent yet.
  if (!status.tail_check || begin_ == accepted_) return true;
  return tail_check(status.next_sequence, accepted_state(), knot_units(accepted_), path_units) ==
         *status.tail_check;
}

/// The node has taken nothing of what was sent for too long.
Result<void, StreamError> NodeStream::silence(BusTime now, PathTime tau) const {
  if (accepted_ == sent_ || now - progress_ <= options_.lost_after) return {};
  return Error<StreamError>({.kind = StreamError::Kind::kSilent,
                             .node_id = node_id_,
                             .line = line_at(tau),
                             .amount = to_seconds(now - progress_) * 1e3});
}

void NodeStream::forget_before(std::int64_t units) {
  if (open_) return;
  while (begin_ < accepted_ && begins_units(begin_ + 1) <= units) ++begin_;
}

std::uint64_t NodeStream::unsent_until(std::int64_t units, std::uint64_t known) const {
  std::uint64_t low = std::min(sent_ + known, end_), high = end_;
  // The answer is near what is known: ever longer steps find a record beyond it.
  for (std::uint64_t step = 1; low + step < end_; step *= 2) {
    if (at(low + step - 1).start_units > units) {
      high = low + step - 1;
      break;
    }
    low += step;
  }
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (at(middle).start_units <= units)
      low = middle + 1;
    else
      high = middle;
  }
  return low - sent_;
}

const NodeStream::Record* NodeStream::covering(std::int64_t units) const {
  // The last record that begins at or before `units`, and is not a START that is still to come.
  const std::uint64_t stop = open_ ? released_ : end_;
  std::uint64_t low = begin_, high = stop;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (at(middle).start_units <= units)
      low = middle + 1;
    else
      high = middle;
  }
  if (low == begin_) return begin_ < stop && at(begin_).duration == 0 ? &at(begin_) : nullptr;
  return &at(low - 1);
}

std::optional<std::array<AxisState, kAxesPerNode>> NodeStream::state_at(PathTime tau) const {
  const Record* record = covering(floor_units(tau));
  if (record == nullptr) return begin_ == end_ ? std::optional(tail_) : std::nullopt;
  const std::int64_t ticks = tau.count() - record->start_units * kPathTicksPerUnit;
  const std::int64_t most = record->duration * kPathTicksPerUnit;
  std::array<AxisState, kAxesPerNode> states;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const std::int64_t t = std::min(ticks, most);
    states[i] = {position_at(record->start[i], record->acceleration[i], t, options_.acceleration_shift),
                 velocity_at(record->start[i], record->acceleration[i], t, options_.acceleration_shift)};
  }
  return states;
}

const std::array<AxisState, kAxesPerNode>& NodeStream::accepted_state() const {
  return accepted_ < end_ ? at(accepted_).start : tail_;
}

std::uint32_t NodeStream::line_at(PathTime tau) const {
  const Record* record = covering(floor_units(tau));
  return record == nullptr ? 0 : record->line;
}

}  // namespace kinebus
