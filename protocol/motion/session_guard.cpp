#include "protocol/motion/session_guard.hpp"

#include <algorithm>
#include <span>

#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus {
namespace {

bool is_sdo(const CanFrame& frame) {
  return cob_id::node_of(frame.id, cob_id::kSdoRequest) != 0;
}

bool concerns(const CanFrame& frame, std::uint8_t node_id) {
  if (frame.id == cob_id::kNmt) return frame.length == 2 && (frame.data[1] == 0 || frame.data[1] == node_id);
  if (frame.id == kRateCobId || frame.id == kSyncStampCobId) return true;
  return frame.id == cob_id::kSdoRequest + node_id || frame.id == cob_id::rpdo(1, node_id);
}

}  // namespace

AbortCode SessionGuard::write(std::uint8_t subindex, std::uint32_t value, bool in_motion) {
  if (in_motion) return AbortCode::kDeviceState;
  if (subindex >= 1 && subindex <= key_.size()) {
    key_[subindex - 1u] = value;
    return AbortCode::kNone;
  }
  const SipHashKey key{key_[0] | std::uint64_t{key_[1]} << 32, key_[2] | std::uint64_t{key_[3]} << 32};
  key_ = {};
  if (value != 0 && key == SipHashKey{}) return AbortCode::kInvalidValue;
  vouchers_.begin(value != 0 ? key : SipHashKey{});
  told_ = 0;
  waiting_ = 0;
  return AbortCode::kNone;
}

// Path time is guarded at rest, too: motion that waits begins by it. So are the objects that say the same.
bool SessionGuard::needed(const CanFrame& frame, bool in_motion) {
  if (in_motion || frame.id == kRateCobId || frame.id == kSyncStampCobId) return true;
  if (!is_sdo(frame)) return false;
  const std::uint16_t index = sdo::address_in(frame).index;
  return index == object::kRateCommand.index || index == object::kSyncStamp.index;
}

SessionGuard::Answer SessionGuard::judge(const CanFrame& frame, std::uint8_t node_id, bool in_motion) {
  if (vouchers_.on_frame(frame)) return Answer::kPass;
  if (!in_force() || !wants_voucher(frame) || !concerns(frame, node_id)) return Answer::kObey;
  if (!in_motion) told_ = 0;
  // Also where it is not needed: the number rises.
  const VoucherReader::Verdict verdict = vouchers_.look(frame);
  if (verdict == VoucherReader::Verdict::kVouched || !needed(frame, in_motion)) return Answer::kObey;
  if (verdict == VoucherReader::Verdict::kDoubled) return Answer::kPass;
  ++refused_;
  // A gateway that was started anew has SYNC before it has given the node its key.
  if (in_motion || frame.id != kSyncStampCobId) tell(frame);
  return Answer::kRefuse;
}

void SessionGuard::tell(const CanFrame& frame) {
  const unsigned bit = 1u << VoucherReader::kind_of(frame);
  if ((told_ & bit) != 0 || waiting_ == refusals_.size()) return;
  told_ |= bit;
  std::array<std::uint8_t, 5>& told = refusals_[waiting_++];
  told = {};
  put_u16_le(std::span(told).subspan(1), static_cast<std::uint16_t>(frame.id));
  if (frame.id == cob_id::kNmt)
    std::copy_n(frame.data.begin(), 2, told.begin() + 3);
  else if (is_sdo(frame))
    put_u16_le(std::span(told).subspan(3), sdo::address_in(frame).index);
}

std::optional<std::array<std::uint8_t, 5>> SessionGuard::next_refusal() {
  if (waiting_ == 0) return std::nullopt;
  return refusals_[--waiting_];
}

}  // namespace kinebus
