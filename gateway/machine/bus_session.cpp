#include "gateway/machine/bus_session.hpp"

#include <array>
#include <cassert>

#include "protocol/bytes.hpp"
#include "protocol/canopen/object_addresses.hpp"

namespace kinebus {

BusSession::BusSession(BusTrust trust, const SipHashKey& secret) : trust_(trust), secret_(secret) {
  assert(trust_ == BusTrust::kOpen || secret_ != SipHashKey{});
}

SipHashKey BusSession::derived(std::uint64_t number) const {
  std::array<std::uint8_t, 8> message{};
  put_u64_le(message, 2 * number);
  const std::uint64_t low = siphash_2_4(secret_, message);
  put_u64_le(message, 2 * number + 1);
  return {low, siphash_2_4(secret_, message)};
}

void BusSession::begin() {
  if (trust_ == BusTrust::kOpen) return;
  key_ = derived(++sessions_);
  if (writers_.size() == VoucherReader::kKept) writers_.erase(writers_.begin());
  writers_.emplace_back(key_);
}

void BusSession::settle() {
  if (writers_.size() > 1) writers_.erase(writers_.begin(), writers_.end() - 1);
}

void BusSession::vouch_for(const CanFrame& frame) {
  for (VoucherWriter& writer : writers_) held_.push_back(writer.vouch_for(frame));
  held_.push_back(frame);
}

std::vector<ParameterWrite> BusSession::key_writes() const {
  if (writers_.empty()) return {};
  std::vector<ParameterWrite> writes;
  const std::array<std::uint64_t, 4> parts{key_.low & 0xFFFF'FFFF, key_.low >> 32, key_.high & 0xFFFF'FFFF,
                                           key_.high >> 32};
  for (std::size_t i = 0; i < parts.size(); ++i)
    writes.push_back(
        {{object::kSessionKey.index, static_cast<std::uint8_t>(object::kSessionKey.subindex + i)},
         4,
         static_cast<std::int64_t>(parts[i])});
  writes.push_back({object::kSessionInForce, 1, 1});
  return writes;
}

}  // namespace kinebus
