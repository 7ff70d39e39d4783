#pragma once
// What a node has to hear of the bus.

#include <array>
#include <span>

#include "node_firmware/board/drivers.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/motion/voucher.hpp"

namespace kinebus {

class Hearing {
 public:
  /// Its own requests and PDOs, what all hear, and the heartbeats that it watches. True: that has changed.
  template <typename Core>
  bool renew(const Core& node) {
    std::array<CanAccept, kCanFilters> wanted{};
    std::size_t count = 0;
    const auto add = [&](std::uint32_t value, std::uint32_t mask = 0x7FF) {
      wanted[count++] = {static_cast<std::uint16_t>(value), static_cast<std::uint16_t>(mask)};
    };
    add(0x080, 0x780);  // SYNC, and the EMCYs of others: stop requests. The first: see hears()
    add(0x000);         // NMT
    add(0x7E5);         // LSS
    add(kVoucherCobId);
    // By its vouchers the number of a session is followed; an axis pair has it among its PDOs.
    if constexpr (requires { Core::kHearsSyncStamps; }) add(kSyncStampCobId);
    if (node.node_id() != 0) {
      add(0x600u + node.node_id());
      if constexpr (requires { node.answers_guarding(); }) {
        if (node.answers_guarding()) {
          add(0x700u + node.node_id());
          wanted[count - 1].remote = true;
        }
      }
      for (const std::uint8_t id : node.watched_nodes())
        if (id != 0) add(0x700u + id);
      for (const std::uint16_t id : node.rpdo_cob_ids())
        if (id != 0) add(id);
    }
    if (wanted == accepted_ && count == count_) return false;
    accepted_ = wanted;
    count_ = count;
    return true;
  }
  /// An EMCY of another node that asks for no stop is heard only where a PDO has its number: most of them are
  /// such, and there may be as many as the bus carries.
  bool hears(const CanFrame& frame) const {
    if (frame.extended) return false;
    for (std::size_t i = asks_for_nothing(frame) ? 1 : 0; i < count_; ++i)
      if ((frame.id & accepted_[i].mask) == accepted_[i].value && frame.remote == accepted_[i].remote)
        return true;
    return false;
  }
  std::span<const CanAccept> accepted() const { return std::span(accepted_).first(count_); }

 private:
  static bool asks_for_nothing(const CanFrame& frame) {
    return frame.id > cob_id::kSync && frame.id <= cob_id::kSync + 127 && (frame.data[3] & 0x7F) == 0;
  }

  std::array<CanAccept, kCanFilters> accepted_{};
  std::size_t count_ = 0;
};

}  // namespace kinebus
