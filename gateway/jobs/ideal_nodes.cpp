#include "gateway/jobs/ideal_nodes.hpp"

#include "protocol/motion/segment.hpp"

namespace kinebus {

void IdealNode::on_frame(const CanFrame& frame) {
  if (frame.id != 0x400u + id_ || frame.length != 8) return;
  const auto segment = decode_segment(get_u64_le(frame.bytes()));
  if (!segment || taken_ - executed_ >= kRing) return;
  if (segment->control == SegmentControl::kStart) tail_units_ = segment->start_units;
  tail_units_ += segment->duration;
  at_rest_ = segment->control == SegmentControl::kEnd;
  if (segment->duration != 0) ++segments_;
  end_units_[taken_++ % kRing] = tail_units_;
}

bool IdealNode::on_time(BusTime now, PathTime tau) {
  const std::int64_t units = tau.count() / kPathTicksPerUnit;
  while (executed_ < taken_ && end_units_[executed_ % kRing] <= units) ++executed_;
  if (executed_ - executed_at_status_ < kRecordsPerStatus && now < next_status_) return false;
  executed_at_status_ = executed_;
  next_status_ = now + kStatusPeriod;
  return true;
}

StreamStatus IdealNode::status(PathTime tau) const {
  StreamStatus status;
  status.next_sequence = static_cast<std::uint8_t>(taken_ % kSequenceModulus);
  status.free_records = static_cast<std::uint8_t>(kQueueRecords - (taken_ - executed_));
  status.flags = StreamStatus::kSynchronised |
                 (at_rest_ && taken_ == executed_ ? StreamStatus::kAtRest : StreamStatus::kRunning);
  status.path_units = static_cast<std::uint32_t>(tau.count() / kPathTicksPerUnit);
  return status;
}

}  // namespace kinebus
