#pragma once
// A node as the stream sees it, written from the contract of segment.hpp alone: decodes frames, checks
// everything that a node checks, and says where its axes are at any path time.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "protocol/can/frame.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/segment.hpp"
#include "protocol/motion/tail_check.hpp"
#include "protocol/time.hpp"

namespace kinebus::testing {

class ModelNode {
 public:
  explicit ModelNode(std::uint8_t id, std::array<AxisState, kAxesPerNode> at = {})
      : id_(id), tail_(at), rest_(at) {}

  void on_frame(const CanFrame& frame) {
    if (frame.id == 0x500u + id_) {
      const Checkpoint c = decode_checkpoint(get_u64_le(frame.data));
      ++checkpoints;
      if (c.sequence != next_) return complain("checkpoint for another record than the next");
      if (!agrees(c, tail_[c.axis])) complain("checkpoint differs");
      return;
    }
    if (frame.id != 0x400u + id_) return;
    const auto segment = decode_segment(get_u64_le(frame.data));
    if (!segment) return complain("unknown record");
    if (segment->sequence != next_) return complain("sequence");
    next_ = static_cast<std::uint8_t>((next_ + 1) % kSequenceModulus);
    if (queued() >= capacity) return complain("more records than free");
    if (segment->control == SegmentControl::kStart) {
      if (segment->start_units * kPathTicksPerUnit < tau_.count()) complain("late start");
      until_ = segment->start_units;
    } else if (segment->control == SegmentControl::kEnd) {
      if (tail_[0].velocity != 0 || tail_[1].velocity != 0) complain("end in motion");
      ended = true;
    } else {
      ended = false;
    }
    history_.push_back({until_, *segment, tail_});
    if (segment->duration != 0)
      for (std::size_t i = 0; i < tail_.size(); ++i)
        tail_[i] = advance(tail_[i], segment->acceleration[i], segment->duration, kDefaultAccelerationShift);
    until_ += segment->duration;
  }

  /// Executes up to this path time.
  void advance_to(PathTime tau) {
    tau_ = tau;
    const std::int64_t units = tau.count() / kPathTicksPerUnit;
    while (executed_ < history_.size() &&
           history_[executed_].start_units + history_[executed_].segment.duration <= units)
      ++executed_;
    if (executed_ == history_.size() && !history_.empty() && !ended && units > until_) complain("underrun");
  }

  StreamStatus status() const {
    StreamStatus s;
    s.next_sequence = next_;
    s.free_records = static_cast<std::uint8_t>(capacity - queued());
    s.flags = StreamStatus::kSynchronised;
    s.path_units = static_cast<std::uint32_t>(tau_.count() / kPathTicksPerUnit);
    s.tail_check = tail_check(next_, tail_, until_, tau_.count() / kPathTicksPerUnit);
    return s;
  }

  /// Position (32 fractional bits) at path time tau, by all records received.
  std::int64_t position(PathTime tau, std::size_t axis) const {
    while (cursor_ > 0 && history_[cursor_].start_units * kPathTicksPerUnit > tau.count()) --cursor_;
    while (cursor_ + 1 < history_.size() &&
           history_[cursor_ + 1].start_units * kPathTicksPerUnit <= tau.count())
      ++cursor_;
    if (history_.empty() || history_[cursor_].start_units * kPathTicksPerUnit > tau.count())
      return rest_[axis].position;
    const Item& item = history_[cursor_];
    if (item.segment.duration == 0) return item.start[axis].position;
    return position_at(item.start[axis], item.segment.acceleration[axis],
                       tau.count() - item.start_units * kPathTicksPerUnit, kDefaultAccelerationShift);
  }

  std::size_t queued() const { return history_.size() - executed_; }
  std::size_t records() const { return history_.size(); }
  std::int64_t until_units() const { return until_; }
  const std::array<AxisState, kAxesPerNode>& tail() const { return tail_; }
  std::uint8_t id() const { return id_; }

  std::size_t capacity = 120;
  bool ended = false;
  std::size_t checkpoints = 0;
  std::string complaint;  ///< the first thing that a real node would have stopped for

 private:
  struct Item {
    std::int64_t start_units;
    Segment segment;
    std::array<AxisState, kAxesPerNode> start;
  };
  void complain(const char* what) {
    if (complaint.empty()) complaint = what;
  }

  std::uint8_t id_;
  std::uint8_t next_ = 0;
  std::array<AxisState, kAxesPerNode> tail_{}, rest_{};
  std::vector<Item> history_;
  std::size_t executed_ = 0;
  mutable std::size_t cursor_ = 0;
  std::int64_t until_ = 0;
  PathTime tau_{0};
};

}  // namespace kinebus::testing
