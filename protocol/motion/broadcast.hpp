#pragma once
// The frames that all nodes hear at once: the time stamp of SYNC, the path-time rate, and the stop instant
// that an EMCY carries. The gateway sends the first two as its own TPDOs (node id 127), so every bus tool
// decodes them.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "protocol/bytes.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/time.hpp"

namespace kinebus {

inline constexpr std::uint8_t kGatewayNodeId = 127;
inline constexpr std::uint32_t kRateCobId = 0x180 + kGatewayNodeId;  // TPDO1 of the gateway: above all PDOs
inline constexpr std::uint32_t kSyncStampCobId = 0x280 + kGatewayNodeId;  // TPDO2 of the gateway

/// Check bits of the broadcasts, beside the bus's own CRC: what goes wrong between a controller's buffer and
/// the program would else move one carriage otherwise than the others. The remainder by x^width +
/// `polynomial` finds every wrong bit, and every burst of up to `width` bits. `payload`: its check bits are
/// 0.
constexpr std::uint8_t check_bits(std::uint64_t payload, int width, unsigned polynomial) {
  const unsigned top = 1u << (width - 1), mask = (1u << width) - 1;
  unsigned rest = mask;  // so that a frame of zeros is no good one
  for (int bit = 63; bit >= 0; --bit) {
    const bool out = ((rest & top) != 0) != ((payload >> bit & 1u) != 0);
    rest = ((rest << 1) ^ (out ? polynomial : 0u)) & mask;
  }
  return static_cast<std::uint8_t>(rest);
}

/// Two-step SYNC: when the SYNC with this counter really was on the bus, on the gateway's clock.
struct SyncStamp {
  std::uint8_t counter = 0;  ///< the counter byte of the SYNC that this stamps, 1..240
  std::uint8_t epoch = 0;    ///< changes when the gateway's clock starts anew
  BusTime time{0};           ///< low 32 bits of the microseconds travel, plus nanoseconds 0..999

  friend constexpr bool operator==(const SyncStamp&, const SyncStamp&) = default;
};

/// Bytes 2, 3: nanoseconds in 10 bits, 6 check bits above them.
constexpr CanFrame encode(const SyncStamp& stamp) {
  CanFrame frame{.id = kSyncStampCobId, .length = 8};
  const std::int64_t us = stamp.time.count() / 1000;
  frame.data[0] = stamp.counter;
  frame.data[1] = stamp.epoch;
  put_u16_le(std::span(frame.data).subspan(2), static_cast<std::uint16_t>(stamp.time.count() % 1000));
  put_u32_le(std::span(frame.data).subspan(4), static_cast<std::uint32_t>(us));
  const std::uint8_t check = check_bits(get_u64_le(frame.data), 6, 0x03);
  frame.data[3] = static_cast<std::uint8_t>(frame.data[3] | (check << 2));
  return frame;
}

/// The full time nearest to `reference` that a 32-bit microsecond value can mean (it wraps after 71 minutes).
constexpr BusTime unwrap_us(std::uint32_t low_us, BusTime reference) {
  const std::int64_t ref_us = reference.count() / 1000;
  const auto delta = static_cast<std::int32_t>(low_us - static_cast<std::uint32_t>(ref_us));
  return BusTime{(ref_us + delta) * 1000};
}

/// As unwrap_us() with 24 bits: within 8 s of `reference`.
constexpr BusTime unwrap_us24(std::uint32_t low_us, BusTime reference) {
  const std::int64_t ref_us = reference.count() / 1000;
  const auto delta = static_cast<std::int32_t>((low_us - static_cast<std::uint32_t>(ref_us)) << 8) >> 8;
  return BusTime{(ref_us + delta) * 1000};
}

/// `reference`: any time within half an hour of the stamp. nullopt: malformed.
constexpr std::optional<SyncStamp> decode_sync_stamp(const CanFrame& frame, BusTime reference) {
  if (frame.length != 8) return std::nullopt;
  const std::uint64_t raw = get_u64_le(frame.data);
  constexpr std::uint64_t kCheck = std::uint64_t{0x3F} << 26;
  if (check_bits(raw & ~kCheck, 6, 0x03) != (raw & kCheck) >> 26) return std::nullopt;
  const auto ns = static_cast<std::uint16_t>(raw >> 16 & 0x3FF);
  if (ns > 999 || frame.data[0] == 0 || frame.data[0] > 240) return std::nullopt;
  return SyncStamp{frame.data[0], frame.data[1],
                   unwrap_us(get_u32_le(std::span(frame.data).subspan(4)), reference) + BusTime{ns}};
}

/// d tau/dt goes from what it is to `rate` along a straight ramp that starts at bus time `start`.
/// The ramp takes `full_ramp` for a change of 1.0, and in proportion less for a smaller one, so that its
/// slope, which is what the joints feel, is the stated one.
/// A smooth ramp takes twice `full_ramp` whatever the change is: for one its slope grows evenly, for the
/// other it falls, so that the joints' acceleration does not jump; at its steepest it has the slope of a
/// straight one. One that is under way comes to a slope of 0 in the same way first. Only nodes that say so
/// follow it (2118h): others take its frame for a malformed one.
struct RateCommand {
  enum class Kind : std::uint8_t {
    kRate = 1,    ///< feed hold (rate 0), resume, override
    kStop = 2,    ///< to rate 0 and latched: only kClear lets kRate and kSmooth work again
    kClear = 3,   ///< lifts the latch; accepted only at rest
    kSmooth = 4,  ///< as kRate, along a smooth ramp
  };
  Kind kind = Kind::kRate;
  std::uint8_t counter = 0;         ///< 0..15, a doubled frame is no second command
  std::uint16_t rate_q15 = 0;       ///< 0..32768 = 0..1.0
  std::uint8_t full_ramp_2ms = 50;  ///< 2 ms units, 1..255
  BusTime start{0};                 ///< whole microseconds

  constexpr bool sets_rate() const { return kind == Kind::kRate || kind == Kind::kSmooth; }
  friend constexpr bool operator==(const RateCommand&, const RateCommand&) = default;
};
inline constexpr std::uint16_t kFullRateQ15 = 32768;
/// 2118h: the node knows Kind::kSmooth.
inline constexpr std::uint32_t kFollowsSmoothRamps = 1;

/// Byte 0: counter and kind; 1, 2: rate; 3: ramp; 4 to 6: start in us, low 24 bits; 7: check bits.
constexpr CanFrame encode(const RateCommand& c) {
  CanFrame frame{.id = kRateCobId, .length = 8};
  frame.data[0] = static_cast<std::uint8_t>((static_cast<unsigned>(c.kind) << 4) | (c.counter & 0xFu));
  put_u16_le(std::span(frame.data).subspan(1), c.rate_q15);
  frame.data[3] = c.full_ramp_2ms;
  put_u32_le(std::span(frame.data).subspan(4),
             static_cast<std::uint32_t>(c.start.count() / 1000) & 0xFF'FFFFu);
  frame.data[7] = check_bits(get_u64_le(frame.data), 8, 0x2F);
  return frame;
}

/// `reference`: any time within 8 s of the start. nullopt: malformed.
constexpr std::optional<RateCommand> decode_rate_command(const CanFrame& frame, BusTime reference) {
  if (frame.length != 8) return std::nullopt;
  if (check_bits(get_u64_le(frame.data) & ~(std::uint64_t{0xFF} << 56), 8, 0x2F) != frame.data[7])
    return std::nullopt;
  const unsigned kind = frame.data[0] >> 4;
  const std::uint16_t rate = get_u16_le(std::span(frame.data).subspan(1));
  if (kind < 1 || kind > 4 || rate > kFullRateQ15 || frame.data[3] == 0) return std::nullopt;
  return RateCommand{static_cast<RateCommand::Kind>(kind), static_cast<std::uint8_t>(frame.data[0] & 0xF),
                     rate, frame.data[3],
                     unwrap_us24(get_u32_le(std::span(frame.data).subspan(4)) & 0xFF'FFFFu, reference)};
}

/// Stop requests of nodes travel in EMCY's five vendor bytes: byte 3 the reason and axis, bytes 4..6 the bus
/// time in microseconds (low 24 bits) at which every node, sender included, starts the stop ramp, byte 7
/// check bits: the EMCY of a foreign device stops nobody by chance. The sender names a time `kStopMargin`
/// ahead, so that the frame reaches all nodes before it; the earliest stop named wins.
inline constexpr BusTime kStopMargin = std::chrono::microseconds{1500};

/// Why a node asks all nodes to stop: the low 7 bits of EMCY's byte 3; bit 7 is the axis that is the cause.
enum class StopReason : std::uint8_t {
  kNone = 0,  ///< this EMCY stops nobody
  kStarved = 1,
  kSequenceError = 2,
  kCheckpointError = 3,
  kStreamError = 4,  ///< unknown record, late start, end in motion, acceleration above the limits
  kEmergencyStopInput = 5,
  kLimitSwitch = 6,
  kGatewayLost = 7,  ///< heartbeat of the gateway missing
  kSyncLost = 8,     ///< needs no frame: every node knows the same instant by itself
  kAxisFault = 9,
  kCommand = 10,  ///< quick stop or switching off by controlword, or NMT, in the middle of a streamed motion
  kPeer = 11,     ///< another node's request, in a node's own records
};

struct StopRequest {
  StopReason reason = StopReason::kNone;
  std::uint8_t axis = 0;
  BusTime start{0};  ///< whole microseconds

  friend constexpr bool operator==(const StopRequest&, const StopRequest&) = default;
};

/// When the stop begins that was heard of at `heard`. No node names an instant that is farther ahead; who
/// does is no node, or has no bus time: then now is the best there is, in whole milliseconds, so that all who
/// heard the frame take the same.
constexpr BusTime stop_instant(const StopRequest& request, BusTime heard) {
  constexpr BusTime kFarthestAhead = std::chrono::milliseconds{10}, kOldest = std::chrono::seconds{1};
  const BusTime ahead = request.start - heard;
  if (ahead <= kFarthestAhead && ahead > -kOldest) return request.start;
  constexpr std::int64_t kMillisecond = 1'000'000;
  return BusTime{(heard + kStopMargin).count() / kMillisecond * kMillisecond};
}

/// The five vendor bytes of EMCY.
constexpr std::array<std::uint8_t, 5> encode(const StopRequest& s) {
  std::array<std::uint8_t, 5> bytes{};
  bytes[0] = static_cast<std::uint8_t>((static_cast<unsigned>(s.reason) & 0x7Fu) | ((s.axis & 1u) << 7));
  if (s.reason == StopReason::kNone) return bytes;
  const std::uint32_t us = static_cast<std::uint32_t>(s.start.count() / 1000) & 0xFF'FFFFu;
  put_u32_le(std::span(bytes).subspan(1), us);
  bytes[4] = check_bits(bytes[0] | std::uint64_t{us} << 8, 8, 0x2F);
  return bytes;
}
/// nullopt: not an EMCY that asks for a stop. `frame`: any frame.
constexpr std::optional<StopRequest> decode_stop_request(const CanFrame& frame, BusTime reference) {
  if (frame.extended || frame.remote || frame.length != 8 || frame.id <= 0x080 || frame.id > 0x0FF)
    return std::nullopt;
  if ((frame.data[3] & 0x7F) == 0) return std::nullopt;
  const std::uint32_t us = get_u32_le(std::span(frame.data).subspan(4)) & 0xFF'FFFFu;
  if (check_bits(frame.data[3] | std::uint64_t{us} << 8, 8, 0x2F) != frame.data[7]) return std::nullopt;
  return StopRequest{static_cast<StopReason>(frame.data[3] & 0x7F),
                     static_cast<std::uint8_t>(frame.data[3] >> 7), unwrap_us24(us, reference)};
}

/// TPDO2 of a node: everything that a stream needs to go on. A node that was asked to (2119h) tells, in place
/// of path time's highest byte, a check of the tail of its queue (tail_check.hpp); bit 7 of the
/// first byte says so.
struct StreamStatus {
  std::uint8_t next_sequence = 0;            ///< 0..127: the record expected next
  std::uint8_t free_records = 0;             ///< room in the queue now
  std::uint8_t flags = 0;                    ///< kStream... below
  std::uint8_t sync_error_us = 0;            ///< bound of the clock estimate's error, saturates at 255
  std::uint32_t path_units = 0;              ///< path time in 16 us units, low 32 bits; 24 beside a check
  std::optional<std::uint8_t> tail_check{};  ///< of the state behind the record before next_sequence

  static constexpr std::uint8_t kRunning = 0x01;  ///< executing records
  static constexpr std::uint8_t kAtRest = 0x02;   ///< queue ended by an end record, or never started
  static constexpr std::uint8_t kStopped = 0x04;  ///< stop latched
  static constexpr std::uint8_t kSequenceError = 0x08;
  static constexpr std::uint8_t kUnderrun = 0x10;
  static constexpr std::uint8_t kCheckpointError = 0x20;
  static constexpr std::uint8_t kSynchronised = 0x40;
  static constexpr std::uint8_t kReordered =
      0x80;  ///< records came in another order than they were sent, since power-up

  /// The path time, in units, nearest to `units` that was meant: within 134 s of it beside a check, else
  /// within 9 hours.
  constexpr std::int64_t path_near(std::int64_t units) const {
    const int unused = tail_check ? 8 : 0;
    const auto ahead = static_cast<std::int32_t>((path_units - static_cast<std::uint32_t>(units)) << unused);
    return units + (ahead >> unused);
  }
};
/// 2118h: the node can tell a check of the tail of its queue.
inline constexpr std::uint32_t kTellsTailCheck = 2;

constexpr std::uint64_t encode(const StreamStatus& s) {
  const std::uint32_t units =
      s.tail_check ? (s.path_units & 0xFF'FFFFu) | std::uint32_t{*s.tail_check} << 24 : s.path_units;
  return static_cast<std::uint64_t>(s.next_sequence | (s.tail_check ? 0x80u : 0u)) |
         (static_cast<std::uint64_t>(s.free_records) << 8) | (static_cast<std::uint64_t>(s.flags) << 16) |
         (static_cast<std::uint64_t>(s.sync_error_us) << 24) | (static_cast<std::uint64_t>(units) << 32);
}
constexpr StreamStatus decode_stream_status(std::uint64_t raw) {
  StreamStatus s{static_cast<std::uint8_t>(raw & 0x7F), static_cast<std::uint8_t>((raw >> 8) & 0xFF),
                 static_cast<std::uint8_t>((raw >> 16) & 0xFF), static_cast<std::uint8_t>((raw >> 24) & 0xFF),
                 static_cast<std::uint32_t>(raw >> 32)};
  if ((raw & 0x80) != 0) {
    s.tail_check = static_cast<std::uint8_t>(s.path_units >> 24);
    s.path_units &= 0xFF'FFFFu;
  }
  return s;
}

}  // namespace kinebus
