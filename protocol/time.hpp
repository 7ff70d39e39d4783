#pragma once
// The three times of Kinebus. They are different types, so that they cannot be mixed up.

#include <chrono>
#include <cstdint>

namespace kinebus {

/// Time on the gateway's bus clock, since the start of its time epoch. What SYNC and time stamp spread to all
/// nodes. A node's own free-running counter is also given in this unit (LocalTime) before the clock estimate
/// maps it.
using BusTime = std::chrono::duration<std::int64_t, std::nano>;
using LocalTime = std::chrono::duration<std::int64_t, std::nano>;

/// Path time tau: the one number that all nodes share. 1/16 us: fine enough that a tick at 450 mm/s is 28 nm.
using PathTime = std::chrono::duration<std::int64_t, std::ratio<1, 16'000'000>>;

/// Segment durations are whole multiples of this: 256 path ticks = 16 us.
inline constexpr std::int64_t kPathTicksPerUnit = 256;
inline constexpr double kSecondsPerUnit = 16e-6;
using SegmentUnits = std::chrono::duration<std::int64_t, std::ratio<256, 16'000'000>>;

inline constexpr double to_seconds(PathTime t) {
  return static_cast<double>(t.count()) / 16e6;
}
inline constexpr double to_seconds(BusTime t) {
  return static_cast<double>(t.count()) * 1e-9;
}

}  // namespace kinebus
