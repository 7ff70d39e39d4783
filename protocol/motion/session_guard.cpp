#include "protocol/motion/session_guard.hpp"

#include <span>
#include <utility>

#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus {
namespace {

bool is_sdo(const CanFrame& frame) {
  return cob_id::node_of(frame.id, cob_id::kSdoRequest) != 0;
}

/// Bytes 1 to 4 of next_refusal().
std::uint32_t order_of(const CanFrame& frame) {
  std::uint32_t what = 0;
  if (frame.id == cob_id::kNmt) what = get_u16_le(frame.data);
  if (is_sdo(frame)) what = sdo::address_in(frame).index;
  return frame.id | what << 16;
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
  lapsed_ = false;
  obeyed_in_lapse_ = 0;
  told_count_ = taken_ = 0;
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
  if (!vouchers_.in_force() || !wants_voucher(frame) || !concerns(frame, node_id)) return Answer::kObey;
  if (!in_motion && taken_ == told_count_) told_count_ = taken_ = 0;
  // Also where it is not needed: the number rises.
  const VoucherReader::Verdict verdict = vouchers_.look(frame);
  if (verdict == VoucherReader::Verdict::kVouched) end_lapse();
  if (verdict == VoucherReader::Verdict::kVouched || !needed(frame, in_motion)) return Answer::kObey;
  if (lapsed_) {
    // The stamp of a gateway that was started anew is no order.
    if (frame.id != kSyncStampCobId) obeyed_in_lapse_ = frame.id;
    return Answer::kObey;
  }
  if (verdict == VoucherReader::Verdict::kDoubled) return Answer::kPass;
  ++refused_;
  // A gateway that was started anew has SYNC before it has given the node its key.
  if (in_motion || frame.id != kSyncStampCobId) tell(order_of(frame));
  return Answer::kRefuse;
}

void SessionGuard::end_lapse() {
  if (!std::exchange(lapsed_, false)) return;
  const std::uint32_t obeyed = std::exchange(obeyed_in_lapse_, 0u);
  if (obeyed != 0) tell(cob_id::kSync | obeyed << 16);
}

void SessionGuard::tell(std::uint32_t order) {
  unsigned of_this_kind = 0;
  for (std::uint32_t other : std::span(told_).first(told_count_)) {
    if (other == order) return;
    if ((other & 0xFFFF) == (order & 0xFFFF)) ++of_this_kind;
  }
  if (of_this_kind < kToldOfAKind && told_count_ < told_.size()) told_[told_count_++] = order;
}

std::optional<std::array<std::uint8_t, 5>> SessionGuard::next_refusal() {
  if (taken_ == told_count_) return std::nullopt;
  std::array<std::uint8_t, 5> told{};
  put_u32_le(std::span(told).subspan(1), told_[taken_++]);
  return told;
}

}  // namespace kinebus
