#include "protocol/canopen/sync.hpp"

namespace kinebus {

std::optional<CanFrame> PlainSyncProducer::next_frame(BusTime now) {
  if (!running_ || now < due_) return std::nullopt;
  due_ += options_.period;
  if (due_ <= now) due_ += (now - due_) / options_.period * options_.period + options_.period;
  if (options_.counter_overflow == 0) return CanFrame{.id = cob_id::kSync};
  last_counter_ = counter_;
  counter_ =
      counter_ >= options_.counter_overflow ? std::uint8_t{1} : static_cast<std::uint8_t>(counter_ + 1);
  return CanFrame::make(cob_id::kSync, {last_counter_});
}

SyncReception decode_sync(const CanFrame& frame, std::uint32_t cob_id, std::uint8_t counter_overflow) {
  SyncReception reception;
  reception.is_sync = frame.id == (cob_id & 0x7FF) && !frame.extended && !frame.remote;
  if (!reception.is_sync) return reception;
  reception.length_error = frame.length != (counter_overflow == 0 ? 0 : 1);
  if (!reception.length_error && counter_overflow != 0) {
    reception.counter = frame.data[0];
    reception.length_error = frame.data[0] == 0 || frame.data[0] > counter_overflow;
  }
  return reception;
}

}  // namespace kinebus
