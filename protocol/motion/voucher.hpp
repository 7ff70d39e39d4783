#pragma once
// The session's check value: what the gateway orders on the bus is vouched for. CAN knows no sender, and the
// frames that matter have no room for more: the frame before says it. A voucher (COB-ID 3FFh, TPDO3 of node
// 127) names the frame that follows by a number that only rises and 48 bits of SipHash-2-4 over number,
// COB-ID, length and data, with a key that the nodes were told at bring-up (2117h).
//
//   3FF#nnnn'mmmmmmmmmmmm  1FF#...        bytes 0, 1: the number's low 16 bits; 2 to 7: the check value
//
// A voucher serves once, for that frame alone. What it protects against, and what not: protocol/README.md.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "protocol/can/frame.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/siphash.hpp"

namespace kinebus {

inline constexpr std::uint32_t kVoucherCobId = 0x380 + kGatewayNodeId;

/// What nodes with a key want vouched for: NMT, the rate and its clearing, SYNC's stamp, RPDO1 (controlwords
/// and modes), and SDO requests that begin to write. Not a stop: whoever asks for one gets it, at once.
bool wants_voucher(const CanFrame& frame);

/// The gateway's end: one session.
class VoucherWriter {
 public:
  explicit VoucherWriter(const SipHashKey& key) : key_(key) {}
  /// To be sent right before `frame`.
  CanFrame vouch_for(const CanFrame& frame);

 private:
  SipHashKey key_;
  std::uint64_t number_ = 0;
};

/// A node's end.
class VoucherReader {
 public:
  enum class Verdict : std::uint8_t {
    kVouched,
    kDoubled,  ///< the same frame as the last good one of its COB-ID: done already
    kRefused,
  };

  static constexpr std::size_t kKinds = 5;
  /// The gateway sends a frame right behind its voucher, or those of several keys; others may have sent false
  /// ones between.
  static constexpr std::size_t kKept = 4;
  /// NMT 0, rate 1, stamp 2, SDO 3, RPDO1 4.
  static std::size_t kind_of(const CanFrame& frame);

  /// A session begins; `key` 0: none is in force.
  void begin(const SipHashKey& key);
  bool in_force() const { return key_ != SipHashKey{}; }
  /// A voucher is kept until its frame comes; true: `frame` was one.
  bool on_frame(const CanFrame& frame);
  /// Looks at a frame that wants_voucher(), and takes its voucher.
  Verdict look(const CanFrame& frame);

 private:
  std::uint64_t full_number(std::uint16_t low) const;

  SipHashKey key_;
  std::uint64_t last_ = 0;              ///< number of the last one that was good
  std::array<CanFrame, kKept> kept_{};  ///< length 0: none
  std::size_t next_ = 0;
  std::array<CanFrame, kKinds> done_{};  ///< the last good frames, by what they are
};

}  // namespace kinebus
