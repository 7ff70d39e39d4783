#pragma once
// The gateway's end of a session: a key that every bring-up makes anew, and a voucher before each frame that
// nodes with that key want vouched for (protocol/motion/voucher.hpp).

#include <cstdint>
#include <deque>
#include <optional>
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
  /// Every node holds the last key. Until then frames are vouched for with those before it, too: what heats
  /// takes a new key only of who holds the old one.
  void settle();
  /// What tells a node the key; empty: the bus is open.
  std::vector<ParameterWrite> key_writes() const;
  /// What is to be sent now. `next()`: the next frame without vouchers.
  template <typename Next>
  std::optional<CanFrame> next_frame(Next next) {
    if (held_.empty()) {
      std::optional<CanFrame> frame = next();
      if (!frame || writers_.empty() || !wants_voucher(*frame)) return frame;
      vouch_for(*frame);
    }
    const CanFrame frame = held_.front();
    held_.pop_front();
    return frame;
  }

 private:
  SipHashKey derived(std::uint64_t number) const;
  void vouch_for(const CanFrame& frame);

  BusTrust trust_;
  SipHashKey secret_, key_;
  std::uint64_t sessions_ = 0;
  std::vector<VoucherWriter> writers_;  ///< the last key's is the last
  std::deque<CanFrame> held_;           ///< vouchers, and their frame
};

}  // namespace kinebus
