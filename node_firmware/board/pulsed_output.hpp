#pragma once
// Power in parts by a switch that the main loop turns on and off: what is owed is counted by the time that
// has really gone by, so that passes of uneven length change the rhythm and not the mean. Off at once where
// nothing is asked for.

#include <cstdint>

#include "protocol/time.hpp"

namespace kinebus {

class PulsedOutput {
 public:
  /// `quantum`: half of it the switch is on too long, or too short; at half power a period is four of it.
  explicit constexpr PulsedOutput(LocalTime quantum) : quantum_(quantum.count()) {}

  /// From `now` on `share` of `full` is asked for, 0 <= share <= full < 2^21. True: on.
  bool step(LocalTime now, std::uint32_t share, std::uint32_t full) {
    const std::int64_t most = 2 * quantum_;
    const std::int64_t gone = (now - last_).count() < most ? (now - last_).count() : most;
    owed_ += gone * (static_cast<std::int64_t>(share_) - (on_ ? full : 0)) / full;
    last_ = now;
    share_ = share;
    if (share == 0 || share >= full) {
      owed_ = 0;
      return on_ = share != 0;
    }
    if (on_ ? owed_ <= -quantum_ / 2 : owed_ >= quantum_ / 2) on_ = !on_;
    if (owed_ > most || owed_ < -most) owed_ = owed_ > 0 ? most : -most;
    return on_;
  }

 private:
  std::int64_t quantum_;
  std::int64_t owed_ = 0;  // ns of full power
  LocalTime last_{0};
  std::uint32_t share_ = 0;
  bool on_ = false;
};

}  // namespace kinebus
