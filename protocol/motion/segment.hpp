#pragma once
// A segment: what one streamed frame tells a node. Duration and one constant acceleration for each of its two
// axes; position and velocity simply continue. The arithmetic below is exact in integers and runs on the
// node, in the gateway and in the simulation alike, so the gateway knows every node's position to the last
// bit.
//
// The frame's 64 bits, least significant first: sequence 7 | duration 13 | acceleration A 22 | acceleration
// B 22.
//   duration 1..8191 units of 16 us (up to 131 ms); duration 0: a control record (see SegmentControl).
//   acceleration: signed, unit 2^(shift+1) * 2^-32 counts/unit^2; with the default shift of 2 that is
//   7.28 counts/s^2, range +-15.3e6 counts/s^2 (11.9 m/s^2 at 0.78125 um a count).
// A wrong bit in a segment shows in the check of the queue's tail that the node tells (tail_check), and at
// the next checkpoint. A wrong start shows in no position: control records carry 3 check bits above
// everything else.

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/bytes.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/time.hpp"

namespace kinebus {

inline constexpr int kAxesPerNode = 2;
inline constexpr int kSequenceModulus = 128;
inline constexpr std::int32_t kMaxSegmentUnits = 8191;
inline constexpr std::int32_t kMaxSegmentAcceleration = (1 << 21) - 1;
inline constexpr int kDefaultAccelerationShift = 2;
inline constexpr int kMaxAccelerationShift = 7;

/// Position and velocity of an axis at a knot (the boundary between two segments).
struct AxisState {
  std::int64_t position = 0;  ///< counts (microsteps), 32 fractional bits
  std::int64_t velocity = 0;  ///< counts per 16 us unit, 32 fractional bits
  friend constexpr bool operator==(const AxisState&, const AxisState&) = default;
};

/// State at the end of a segment of `units` with raw acceleration `acceleration`. Exact: no rounding.
constexpr AxisState advance(AxisState s, std::int32_t acceleration, std::int64_t units, int shift) {
  const std::int64_t a = static_cast<std::int64_t>(acceleration) << shift;
  return {s.position + s.velocity * units + a * units * units, s.velocity + 2 * a * units};
}

/// Position (32 fractional bits) `ticks` path ticks after the knot, 0 <= ticks <= 256 * kMaxSegmentUnits.
/// Rounds towards minus infinity; equals advance() at whole units.
constexpr std::int64_t position_at(AxisState s, std::int32_t acceleration, std::int64_t ticks, int shift) {
  return s.position + ((s.velocity * ticks) >> 8) +
         ((static_cast<std::int64_t>(acceleration) * ticks * ticks) >> (16 - shift));
}

/// Velocity in counts per unit, 32 fractional bits.
constexpr std::int64_t velocity_at(AxisState s, std::int32_t acceleration, std::int64_t ticks, int shift) {
  return s.velocity + ((static_cast<std::int64_t>(acceleration) * ticks) >> (7 - shift));
}

/// What a record of duration 0 says. `start`: the following segments begin at path time `start_units` (in 16
/// us units; a knot is always on this grid). `end`: motion ends here, at rest; an empty queue is then no
/// underrun.
enum class SegmentControl : std::uint8_t { kNone = 0, kStart = 1, kEnd = 2 };

struct Segment {
  std::uint8_t sequence = 0;   ///< 0..127, counts every record of a node, control records included
  std::uint16_t duration = 0;  ///< units of 16 us; 0: control record
  std::array<std::int32_t, kAxesPerNode> acceleration{};
  SegmentControl control = SegmentControl::kNone;
  std::int64_t start_units = 0;  ///< kStart only; 0 .. 2^39-1 (101 days of motion)

  friend constexpr bool operator==(const Segment&, const Segment&) = default;
};

/// Of a control record: remainder of its low 61 bits by x^3 + x + 1, inverted.
constexpr std::uint64_t control_check(std::uint64_t raw) {
  unsigned rest = 0;
  for (int bit = 60; bit >= 0; --bit) {
    rest = (rest << 1) | static_cast<unsigned>(raw >> bit & 1u);
    if ((rest & 8u) != 0) rest ^= 0b1011u;
  }
  return rest ^ 7u;
}

constexpr std::uint64_t encode(const Segment& s) {
  constexpr std::uint64_t mask22 = (1u << 22) - 1;
  std::uint64_t raw = (s.sequence & 0x7Fu) | (static_cast<std::uint64_t>(s.duration & 0x1FFFu) << 7);
  if (s.duration != 0)
    raw |= ((static_cast<std::uint64_t>(s.acceleration[0]) & mask22) << 20) |
           ((static_cast<std::uint64_t>(s.acceleration[1]) & mask22) << 42);
  else
    raw |= (static_cast<std::uint64_t>(s.control) << 20) |
           ((static_cast<std::uint64_t>(s.start_units) & ((std::uint64_t{1} << 39) - 1)) << 22);
  if (s.duration == 0) raw |= control_check(raw) << 61;
  return raw;
}

/// nullopt: a control record of an unknown kind, or one with wrong check bits.
constexpr std::optional<Segment> decode_segment(std::uint64_t raw) {
  Segment s;
  s.sequence = static_cast<std::uint8_t>(raw & 0x7F);
  s.duration = static_cast<std::uint16_t>((raw >> 7) & 0x1FFF);
  if (s.duration != 0) {
    s.acceleration[0] = static_cast<std::int32_t>(static_cast<std::int64_t>(raw << 22) >> 42);
    s.acceleration[1] = static_cast<std::int32_t>(static_cast<std::int64_t>(raw) >> 42);
    return s;
  }
  const auto control = (raw >> 20) & 0x3;
  if (control != 1 && control != 2) return std::nullopt;
  if (control_check(raw & ~(std::uint64_t{7} << 61)) != raw >> 61) return std::nullopt;
  s.control = static_cast<SegmentControl>(control);
  s.start_units = static_cast<std::int64_t>(raw >> 22 & ((std::uint64_t{1} << 39) - 1));
  return s;
}

/// An absolute checkpoint: what the state of one axis must be at the knot *before* record `sequence` is
/// executed. Bits: sequence 7 | axis 1 | position, the 56 bits above the 8 lowest of AxisState::position (24
/// fractional bits and 32 of whole counts). The node compares exactly and stops on the path when it differs.
struct Checkpoint {
  std::uint8_t sequence = 0;
  std::uint8_t axis = 0;
  std::int64_t position = 0;  ///< as AxisState::position, low 8 bits zero
};

constexpr std::uint64_t encode(const Checkpoint& c) {
  return (c.sequence & 0x7Fu) | (static_cast<std::uint64_t>(c.axis & 1u) << 7) |
         (static_cast<std::uint64_t>(c.position >> 8) << 8);
}
constexpr Checkpoint decode_checkpoint(std::uint64_t raw) {
  return {static_cast<std::uint8_t>(raw & 0x7F), static_cast<std::uint8_t>((raw >> 7) & 1),
          (static_cast<std::int64_t>(raw) >> 8) * 256};
}
constexpr bool agrees(const Checkpoint& c, const AxisState& s) {
  return (s.position >> 8) == (c.position >> 8);
}

}  // namespace kinebus
