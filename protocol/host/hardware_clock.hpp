#pragma once
// The clock of a CAN adapter that stamps its frames, as this computer's.

#include <algorithm>
#include <optional>

#include "protocol/time.hpp"

namespace kinebus {

/// A frame's way from the bus to this computer takes a time that changes from one to the next (USB,
/// interrupts, a busy processor), but never less than its shortest: that is taken for all. What is left is
/// the adapter's own resolution, and a constant. Crystals may differ by 300 ppm.
class HardwareClock {
 public:
  /// When a frame was on the bus, in the clock of `received`; never later than that. `stamp`: the adapter's.
  LocalTime at(LocalTime stamp, LocalTime received) {
    const LocalTime way = received - stamp;
    if (!way_ || way < *way_ || way - *way_ > kAnotherClock) {
      way_ = way;
    } else if (received > seen_) {
      // The adapter's crystal may be the slower one: then the way seems to grow.
      way_ = std::min(way, *way_ + (received - seen_) / kDrift);
    }
    seen_ = received;
    return stamp + *way_;
  }

 private:
  // The adapter's was set. A single frame that was so late is told by what comes behind it.
  static constexpr LocalTime kAnotherClock = std::chrono::milliseconds{50};
  static constexpr int kDrift = 3333;  // 300 ppm
  std::optional<LocalTime> way_;       ///< from the adapter's time to ours, the shortest way included
  LocalTime seen_{0};
};

}  // namespace kinebus
