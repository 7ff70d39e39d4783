#pragma once
// The gateway's end of a session: a key that every bring-up makes anew, and a voucher before each frame that
// nodes with that key want vouched for (protocol/motion/voucher.hpp).

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "gateway/bus_nodes/node_configuration.hpp"
#include "gateway/description/machine_description.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/motion/voucher.hpp"

namespace kinebus {

class BusSession {
 public:
  /// `secret`: random, of this start of the gateway; every key is derived from it. Not 0 with
  /// BusTrust::kSession.
  BusSession(BusTrust trust, const SipHashKey& secret);

  /// Another key: nodes are about to be brought up.
  void begin();
  /// What tells a node the key; empty: the bus is open.
  std::vector<ParameterWrite> key_writes() const;
  /// What is to be sent now. `next()`: the next frame without vouchers.
  template <typename Next>
  std::optional<CanFrame> next_frame(Next next) {
    if (held_) return std::exchange(held_, std::nullopt);
    std::optional<CanFrame> frame = next();
    if (!frame || !writer_ || !wants_voucher(*frame)) return frame;
    held_ = frame;
    return writer_->vouch_for(*frame);
  }

 private:
  SipHashKey derived(std::uint64_t number) const;

  BusTrust trust_;
  SipHashKey secret_, key_;
  std::uint64_t sessions_ = 0;
  std::optional<VoucherWriter> writer_;
  std::optional<CanFrame> held_;  ///< its voucher was sent
};

}  // namespace kinebus
