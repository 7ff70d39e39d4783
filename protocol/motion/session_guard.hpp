#pragma once
// What a node with a session's key does not do while motion runs, unless the gateway vouches for it: change
// of its NMT state, controlwords and modes (RPDO1), anything that SDO writes; and, moving or not, path time's
// rate and SYNC's stamp. Without a key it obeys every master.

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/can/frame.hpp"
#include "protocol/canopen/abort_code.hpp"
#include "protocol/motion/voucher.hpp"

namespace kinebus {

class SessionGuard {
 public:
  enum class Answer : std::uint8_t {
    kObey,
    kPass,    ///< not to be obeyed: done already
    kRefuse,  ///< not to be obeyed, and counted
  };

  /// 2117h: 1 to 4 are the key, 5 puts it in force (1) or ends the session (0). In motion neither.
  AbortCode write(std::uint8_t subindex, std::uint32_t value, bool in_motion);
  bool in_force() const { return vouchers_.in_force() && !lapsed_; }
  /// NMT reset: whoever is master then need not know the key.
  void end() { vouchers_.begin({}); }
  /// The gateway is silent. Everybody is obeyed, as without a key, until a voucher says that it is back.
  void lapse() { lapsed_ = vouchers_.in_force(); }

  /// `in_motion`: of this node or of what it shares the path with.
  Answer judge(const CanFrame& frame, std::uint8_t node_id, bool in_motion);
  /// False: judge() asks nobody for a voucher, and it is all the same whether anything moves.
  bool has_key() const { return vouchers_.in_force(); }
  /// What was refused, for EMCY: each order once a motion, up to kToldOfAKind of a kind. Bytes 1, 2: its
  /// COB-ID; 3, 4: NMT's command and node, or SDO's index. COB-ID 080h, SYNC's: what nobody vouched for was
  /// obeyed while the session had lapsed; 3, 4: its COB-ID.
  std::optional<std::array<std::uint8_t, 5>> next_refusal();
  std::uint32_t refused() const { return refused_; }

 private:
  /// NMT and SDO have so many different orders; whoever tries more is counted.
  static constexpr std::uint8_t kToldOfAKind = 6;

  static bool needed(const CanFrame& frame, bool in_motion);
  void tell(std::uint32_t order);
  void end_lapse();

  VoucherReader vouchers_;
  std::array<std::uint32_t, 4> key_{};
  std::uint32_t refused_ = 0;
  bool lapsed_ = false;
  std::uint32_t obeyed_in_lapse_ = 0;  ///< the COB-ID of a frame that would have been refused; 0: none
  /// Of this motion: NMT and SDO, and one each of rate, stamp, RPDO1 and lapse.
  std::array<std::uint32_t, 2 * kToldOfAKind + 4> told_{};  ///< bytes 1 to 4 of next_refusal()
  std::uint8_t told_count_ = 0, taken_ = 0;
};

}  // namespace kinebus
