#include "protocol/motion/voucher.hpp"

#include <span>

#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus {
namespace {

constexpr std::uint64_t kCheckMask = (std::uint64_t{1} << 48) - 1;

std::uint64_t check_value(const SipHashKey& key, std::uint64_t number, const CanFrame& frame) {
  std::array<std::uint8_t, 24> message{};
  const std::span<std::uint8_t> bytes(message);
  put_u64_le(bytes, number);
  put_u32_le(bytes.subspan(8), frame.id);
  message[12] = frame.length;
  for (std::size_t i = 0; i < frame.length && i < frame.data.size(); ++i) message[16 + i] = frame.data[i];
  return siphash_2_4(key, message) & kCheckMask;
}

std::uint64_t check_value_in(const CanFrame& voucher) {
  return get_u64_le(voucher.data) >> 16;
}

}  // namespace

bool wants_voucher(const CanFrame& frame) {
  if (frame.extended || frame.remote) return false;
  if (frame.id == cob_id::kNmt || frame.id == kSyncStampCobId) return true;
  if (cob_id::node_of(frame.id, cob_id::rpdo(1, 0)) != 0) return true;
  if (frame.id == kRateCobId)
    return frame.length != 8 || frame.data[0] >> 4 != static_cast<unsigned>(RateCommand::Kind::kStop);
  return cob_id::node_of(frame.id, cob_id::kSdoRequest) != 0 && sdo::begins_to_write(frame);
}

CanFrame VoucherWriter::vouch_for(const CanFrame& frame) {
  ++number_;
  CanFrame voucher{.id = kVoucherCobId, .length = 8};
  put_u64_le(voucher.data, check_value(key_, number_, frame) << 16 | (number_ & 0xFFFF));
  return voucher;
}

std::size_t VoucherReader::kind_of(const CanFrame& frame) {
  if (frame.id == cob_id::kNmt) return 0;
  if (frame.id == kRateCobId) return 1;
  if (frame.id == kSyncStampCobId) return 2;
  return cob_id::node_of(frame.id, cob_id::kSdoRequest) != 0 ? 3 : 4;
}

void VoucherReader::begin(const SipHashKey& key) {
  *this = {};
  key_ = key;
}

bool VoucherReader::on_frame(const CanFrame& frame) {
  if (frame.extended || frame.remote || frame.id != kVoucherCobId) return false;
  if (frame.length != 8 || !in_force()) return true;
  kept_[next_] = frame;
  next_ = (next_ + 1) % kKept;
  return true;
}

// The first number above the last good one that ends so: half an hour of lost vouchers at 20 SYNCs a second.
std::uint64_t VoucherReader::full_number(std::uint16_t low) const {
  const auto ahead = static_cast<std::uint16_t>(low - static_cast<std::uint16_t>(last_));
  return last_ + (ahead == 0 ? 0x10000u : ahead);
}

VoucherReader::Verdict VoucherReader::look(const CanFrame& frame) {
  for (CanFrame& kept : kept_) {
    if (kept.length == 0) continue;
    const std::uint64_t number = full_number(get_u16_le(kept.data));
    if (check_value(key_, number, frame) != check_value_in(kept)) continue;
    last_ = number;
    kept = {};
    done_[kind_of(frame)] = frame;
    return Verdict::kVouched;
  }
  const CanFrame& done = done_[kind_of(frame)];
  return done.length != 0 && done == frame ? Verdict::kDoubled : Verdict::kRefused;
}

}  // namespace kinebus
