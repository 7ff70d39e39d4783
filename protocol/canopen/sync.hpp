#pragma once
// SYNC with its counter byte (1005h, 1006h, 1019h).

#include <cstdint>
#include <optional>

#include "protocol/can/frame.hpp"
#include "protocol/canopen/abort_code.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/time.hpp"

namespace kinebus {

inline constexpr std::uint8_t kSyncCounterOverflow = 240;

/// Sends SYNC on a fixed grid of times, without the stamps that follow it on a Kinebus
/// (stream/sync_producer.hpp).
class PlainSyncProducer {
 public:
  struct Options {
    BusTime period = std::chrono::milliseconds{50};
    std::uint8_t counter_overflow = kSyncCounterOverflow;  ///< 2..240; 0: no counter byte
  };
  PlainSyncProducer() = default;
  explicit PlainSyncProducer(Options options) : options_(options) {}

  void start(BusTime first) {
    due_ = first;
    counter_ = 1;
    running_ = true;
  }
  void stop() { running_ = false; }
  /// Takes effect after the SYNC that is due next.
  void set_period(BusTime period) { options_.period = period; }
  BusTime next_deadline() const { return running_ ? due_ : BusTime::max(); }
  /// The SYNC, if due. A late call keeps to the grid; periods that passed altogether are left out.
  std::optional<CanFrame> next_frame(BusTime now);
  /// Counter of the SYNC sent last; 0: none yet, or no counter.
  std::uint8_t last_counter() const { return last_counter_; }

 private:
  Options options_{};
  BusTime due_{0};
  std::uint8_t counter_ = 1;
  std::uint8_t last_counter_ = 0;
  bool running_ = false;
};

/// CiA 301 on writing 1019h: 1 is no counter, and it changes only while 1006h is 0.
constexpr AbortCode sync_counter_refused(std::int64_t wanted, std::int64_t present, std::int64_t period) {
  if (wanted == 1) return AbortCode::kInvalidValue;
  return wanted != present && period != 0 ? AbortCode::kDeviceState : AbortCode::kNone;
}

/// What a SYNC frame says to a consumer whose 1005h and 1019h are these.
struct SyncReception {
  bool is_sync = false;
  bool length_error = false;  ///< EMCY 8240h: counter byte missing or unexpected
  std::uint8_t counter = 0;   ///< 1..240, or 0 without counter
};
SyncReception decode_sync(const CanFrame& frame, std::uint32_t cob_id = cob_id::kSync,
                          std::uint8_t counter_overflow = kSyncCounterOverflow);

}  // namespace kinebus
