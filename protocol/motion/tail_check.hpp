#pragma once
// What a node has made of the records so far, in 8 bits: stream statuses tell it, and who has sent the
// records compares.

#include <array>
#include <cstdint>

#include "protocol/motion/segment.hpp"

namespace kinebus {

/// Of the exact state and path time at the knot before record `next_sequence`, and of what of the present
/// path time a status has no room for beside this. Every wrong bit of a record changes that state, and for as
/// long as the queue lasts: one wrong state in 256 has the right check, at another record anew. Cost: eleven
/// products of 32 bits.
constexpr std::uint8_t tail_check(std::uint8_t next_sequence, const std::array<AxisState, kAxesPerNode>& axes,
                                  std::int64_t knot_units, std::int64_t path_units) {
  std::uint32_t sum = next_sequence;
  const auto mix = [&sum](std::uint32_t bits) {
    sum = (sum + bits) * 0x9E37'79B1;
    sum ^= sum >> 15;  // what is wrong in high bits alone is not lost, and wrong by the same is not the same
  };
  const auto mix_both = [&mix](std::int64_t value) {
    mix(static_cast<std::uint32_t>(value));
    mix(static_cast<std::uint32_t>(value >> 32));
  };
  for (const AxisState& axis : axes) {
    mix_both(axis.position);
    mix_both(axis.velocity);
  }
  mix_both(knot_units);
  mix(static_cast<std::uint32_t>(path_units >> 24));
  return static_cast<std::uint8_t>(sum >> 24);
}

}  // namespace kinebus
