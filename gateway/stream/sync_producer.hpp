#pragma once
// SYNC with counter at a fixed period, and after each the stamp that says when it really went out.

#include <cstdint>
#include <optional>

#include "protocol/can/frame.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/time.hpp"

namespace kinebus {

inline constexpr std::uint32_t kSyncCobId = 0x080;

/// The gateway's SYNC. (protocol/canopen/sync.hpp has the plain one of CiA 301.)
class StampedSyncProducer {
 public:
  struct Options {
    BusTime period{std::chrono::milliseconds{50}};
    std::uint8_t epoch = 0;
  };
  struct Counters {
    std::uint32_t syncs = 0, stamps = 0;
    std::uint32_t late = 0;       ///< SYNC periods that were passed over
    std::uint32_t unstamped = 0;  ///< SYNCs whose sending was never reported before the next was due
  };

  StampedSyncProducer() : StampedSyncProducer(Options{}) {}
  explicit StampedSyncProducer(Options options) : options_(options) {}

  /// SYNC first falls due at `first`.
  void start(BusTime first);
  void set_period(BusTime period, BusTime now);
  /// A new time epoch: the gateway's clock began anew.
  void restart(std::uint8_t epoch, BusTime first);
  /// The stamp of the last SYNC, or a SYNC that is due; nullopt: nothing now.
  std::optional<CanFrame> next_frame(BusTime now);
  /// A frame really was on the bus; `when` is the end of the frame as the controller saw it.
  void on_frame_sent(BusTime when, const CanFrame& frame);
  BusTime period() const { return options_.period; }
  BusTime next_deadline() const { return due_; }
  std::uint8_t counter() const { return counter_; }
  const Counters& counters() const { return counters_; }

 private:
  Options options_;
  Counters counters_;
  BusTime due_ = BusTime::max();
  std::uint8_t counter_ = 0;  ///< of the SYNC last handed out
  bool awaiting_sent_ = false;
  std::optional<SyncStamp> stamp_;
};

}  // namespace kinebus
