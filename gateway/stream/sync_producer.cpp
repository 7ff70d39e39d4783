#include "gateway/stream/sync_producer.hpp"

#include <algorithm>

#include "protocol/canopen/sync.hpp"

namespace kinebus {

void StampedSyncProducer::start(BusTime first) {
  due_ = first;
  awaiting_sent_ = false;
  stamp_.reset();
}

void StampedSyncProducer::set_period(BusTime period, BusTime now) {
  options_.period = period;
  if (due_ != BusTime::max()) due_ = std::min(due_, now + period);
}

void StampedSyncProducer::restart(std::uint8_t epoch, BusTime first) {
  options_.epoch = epoch;
  start(first);
}

std::optional<CanFrame> StampedSyncProducer::next_frame(BusTime now) {
  if (stamp_) {
    const CanFrame frame = encode(*stamp_);
    stamp_.reset();
    ++counters_.stamps;
    return frame;
  }
  if (now < due_) return std::nullopt;
  if (awaiting_sent_) ++counters_.unstamped;
  due_ += options_.period;
  if (due_ <= now) {
    const auto missed = static_cast<std::uint32_t>((now - due_) / options_.period + 1);
    counters_.late += missed;
    due_ += missed * options_.period;
  }
  counter_ = counter_ >= kSyncCounterOverflow ? std::uint8_t{1} : static_cast<std::uint8_t>(counter_ + 1);
  awaiting_sent_ = true;
  ++counters_.syncs;
  return CanFrame::make(kSyncCobId, {counter_});
}

void StampedSyncProducer::on_frame_sent(BusTime when, const CanFrame& frame) {
  if (!awaiting_sent_ || frame.extended || frame.id != kSyncCobId || frame.length != 1 ||
      frame.data[0] != counter_)
    return;
  awaiting_sent_ = false;
  stamp_ = SyncStamp{counter_, options_.epoch, when};
}

}  // namespace kinebus
