#pragma once
// The clock of the daemon's loop: everything on the loop takes its time from here.

#include <cstdint>

#include "protocol/time.hpp"

namespace kinebus {

/// With real nodes it is the monotonic clock. With simulated ones it is a clock of their own that stands
/// while the process is not run: a computer that is too busy makes such a machine slow, never late.
class LoopClock {
 public:
  enum class Kind : std::uint8_t {
    kMonotonic,
    kOwn,  ///< begins as the monotonic clock and falls behind it by every stall
  };
  /// What one step of an own clock may take. Nodes and gateway allow each other many times that.
  static constexpr LocalTime kLongestStep = std::chrono::milliseconds{2};

  explicit LoopClock(Kind kind) : kind_(kind) {}

  LocalTime now() { return read(read_monotonic()); }
  /// The loop has slept since it read `from`, on this clock, and was to wake at `until` at the latest.
  LocalTime woken(LocalTime from, LocalTime until) { return woken(from, until, read_monotonic()); }
  /// The monotonic clock's time at `time` of this one, if nothing stalls before.
  LocalTime monotonic_at(LocalTime time) const;
  /// How far it has fallen behind the monotonic clock.
  LocalTime behind() const { return behind_; }

  /// The same with the monotonic clock's reading given.
  LocalTime read(LocalTime monotonic);
  LocalTime woken(LocalTime from, LocalTime until, LocalTime monotonic);

 private:
  static LocalTime read_monotonic();

  Kind kind_;
  LocalTime seen_ = LocalTime::max();  ///< the last reading of the monotonic clock; max: none yet
  LocalTime behind_{0};
};

}  // namespace kinebus
