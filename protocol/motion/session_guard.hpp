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
  bool in_force() const { return vouchers_.in_force(); }
  /// NMT reset: whoever is master then need not know the key.
  void end() { vouchers_.begin({}); }

  /// `in_motion`: of this node or of what it shares the path with.
  Answer judge(const CanFrame& frame, std::uint8_t node_id, bool in_motion);
  /// What was refused, for EMCY: once for each kind of frame and motion. Bytes 1, 2: its COB-ID; 3, 4: NMT's
  /// command and node, or SDO's index.
  std::optional<std::array<std::uint8_t, 5>> next_refusal();
  std::uint32_t refused() const { return refused_; }

 private:
  static bool needed(const CanFrame& frame, bool in_motion);
  void tell(const CanFrame& frame);

  VoucherReader vouchers_;
  std::array<std::uint32_t, 4> key_{};
  std::uint32_t refused_ = 0;
  unsigned told_ = 0;  ///< a bit for each kind
  std::array<std::array<std::uint8_t, 5>, VoucherReader::kKinds> refusals_{};
  std::uint8_t waiting_ = 0;
};

}  // namespace kinebus
