#pragma once
// One estimate of bus time for all nodes behind a CAN controller: each tells it of the SYNCs and stamps that
// they all hear, and each counts once. A frame is known by its time of arrival, which no other frame has.

#include "protocol/can/frame.hpp"
#include "protocol/motion/clock_estimate.hpp"

namespace kinebus {

class BusClock {
 public:
  explicit BusClock(int window = ClockEstimate::kWindow) : estimate_(window) {}

  /// `counter` 0: the node that tells it does not count SYNCs.
  void on_sync(std::uint8_t counter, LocalTime arrival) {
    if (counter == 0 || arrival == sync_) return;
    sync_ = arrival;
    estimate_.on_sync(counter, arrival);
  }
  /// As ClockEstimate::on_stamp(), from the frame; malformed: nothing.
  ClockEstimate::Update on_stamp(const CanFrame& frame, LocalTime now) {
    if (now == stamped_) return update_;
    const auto stamp = decode_sync_stamp(frame, estimate_.to_bus(now));
    if (!stamp) return {};
    stamped_ = now;
    return update_ = estimate_.on_stamp(*stamp, now);
  }
  const ClockEstimate& estimate() const { return estimate_; }

 private:
  ClockEstimate estimate_;
  LocalTime sync_ = LocalTime::min(), stamped_ = LocalTime::min();
  ClockEstimate::Update update_;
};

}  // namespace kinebus
