#pragma once
// The fixed-point arithmetic of profiles made on the node. Integers only, no 128-bit type (the Cortex-M4 has
// none), so that every platform gives the same bits. One copy of each longer function: a small chip's image
// has no room for one at every call.
//
//   position      counts, 32 fractional bits, |position| <= kPositionBound
//   velocity      counts per tick, 56 fractional bits
//   acceleration  counts per tick^2, 60 fractional bits (limits; a ramp itself has more)
//   tick          1/16 us of local time

#include <cstdint>

#include "protocol/time.hpp"

namespace kinebus {

inline constexpr std::int64_t kOneCount = std::int64_t{1} << 32;
/// 2^30 counts: half of what 32 bits hold, so that no difference of two positions leaves 64 bits.
inline constexpr std::int64_t kPositionBound = std::int64_t{1} << 62;
inline constexpr std::int64_t kTicksPerSecond = 16'000'000;
/// 2^24 counts/s (13 m/s at 0.78125 um): keeps a velocity below 2^57.
inline constexpr std::uint32_t kMaxCountsPerSecond = 1u << 24;

using ProfileTicks = std::int64_t;

/// value / 125 without a division, which takes the Cortex-M4 some 200 cycles. value < 2^61.
constexpr std::uint64_t divided_by_125(std::uint64_t value) {
  // 2^68 / 125, rounded up; the product's bits 68 and up.
  constexpr std::uint64_t kHigh = 0x20C4'9BA5u, kLow = 0xE353'F7CFu;
  const std::uint64_t v0 = value & 0xFFFF'FFFFu, v1 = value >> 32;
  const std::uint64_t middle = v1 * kLow + ((v0 * kLow) >> 32);
  const std::uint64_t middle2 = v0 * kHigh + (middle & 0xFFFF'FFFFu);
  return (v1 * kHigh + (middle >> 32) + (middle2 >> 32)) >> 4;
}

/// Exact for the grid of both units: 1 ns = 2/125 ticks. Rounds down. Within +-36 years.
[[gnu::noinline]] constexpr ProfileTicks to_ticks(LocalTime t) {
  const std::int64_t ns = t.count();
  if (ns >= 0) return static_cast<ProfileTicks>(divided_by_125(static_cast<std::uint64_t>(ns) * 2));
  return -static_cast<ProfileTicks>(divided_by_125(static_cast<std::uint64_t>(-ns) * 2 + 124));
}
/// The first whole nanosecond that is not before `ticks`.
[[gnu::noinline]] constexpr LocalTime to_local(ProfileTicks ticks) {
  return LocalTime{(ticks >> 1) * 125 + ((ticks & 1) != 0 ? 63 : 0)};
}

constexpr std::int64_t velocity_from(std::uint32_t counts_per_s) {
  constexpr std::int64_t kPerTick = (std::int64_t{1} << 56) / kTicksPerSecond;
  return static_cast<std::int64_t>(counts_per_s < kMaxCountsPerSecond ? counts_per_s : kMaxCountsPerSecond) *
         kPerTick;
}
/// Rounds towards zero, at least 1.
[[gnu::noinline]] constexpr std::int64_t acceleration_from(std::uint32_t counts_per_s2) {
  // 2^60 / (16e6)^2 = 4503.599627
  const std::uint64_t a = static_cast<std::uint64_t>(counts_per_s2) * 4'503'599'627u / 1'000'000u;
  return a == 0 ? 1 : static_cast<std::int64_t>(a);
}
/// Counts per second, rounded to nearest.
[[gnu::noinline]] constexpr std::int32_t counts_per_second(std::int64_t velocity) {
  // 16e6 / 2^56: in two shifts, to stay within 64 bits.
  const std::int64_t scaled = (velocity >> 24) * kTicksPerSecond;
  return static_cast<std::int32_t>((scaled + (std::int64_t{1} << 31)) >> 32);
}

/// velocity * ticks as a distance with 32 fractional bits, rounded down. ticks >= 0.
[[gnu::noinline]] constexpr std::int64_t distance_of(std::int64_t velocity, ProfileTicks ticks) {
  constexpr std::uint64_t kLow = (1u << 24) - 1;
  const auto high = static_cast<std::uint64_t>(velocity >> 24);
  const auto low = static_cast<std::uint64_t>(velocity) & kLow;
  const auto t = static_cast<std::uint64_t>(ticks);
  return static_cast<std::int64_t>(high * t + low * (t >> 24) + ((low * (t & kLow)) >> 24));
}

/// The velocity that covers `distance` (32 fractional bits, >= 0) in `ticks` (> 0); rounded down.
[[gnu::noinline]] constexpr std::int64_t velocity_over(std::uint64_t distance, ProfileTicks ticks) {
  const auto divisor = static_cast<std::uint64_t>(ticks);
  std::uint64_t quotient = distance / divisor;
  std::uint64_t rest = distance % divisor;
  for (int bit = 0; bit < 24; ++bit) {
    quotient <<= 1;
    rest <<= 1;
    if (rest >= divisor) {
      rest -= divisor;
      ++quotient;
    }
  }
  return static_cast<std::int64_t>(quotient);
}

/// Largest r with r*r <= value.
[[gnu::noinline]] constexpr std::uint64_t square_root(std::uint64_t value) {
  std::uint64_t root = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 62; bit != 0; bit >>= 2) {
    if (value >= root + bit) {
      value -= root + bit;
      root = (root >> 1) + bit;
    } else {
      root >>= 1;
    }
  }
  return root;
}

constexpr std::int64_t divide_up(std::int64_t value, std::int64_t divisor) {
  return (value + divisor - 1) / divisor;
}

/// Nearest whole count, as the 32-bit objects show a position.
constexpr std::int32_t whole_counts(std::int64_t position) {
  return static_cast<std::int32_t>((position + (kOneCount >> 1)) >> 32);
}
constexpr std::int64_t from_counts(std::int64_t counts) {
  return counts * kOneCount;
}

}  // namespace kinebus
