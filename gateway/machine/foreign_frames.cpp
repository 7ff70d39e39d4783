#include "gateway/machine/foreign_frames.hpp"

#include <algorithm>

#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/sdo.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/voucher.hpp"

namespace kinebus {
namespace {

/// RPDO3 of node n.
constexpr std::uint32_t kRecordCobId = cob_id::rpdo(3, 0);

bool is_of_a_gateway(std::uint32_t id) {
  return id == cob_id::kSync || id == kRateCobId || id == kSyncStampCobId || id == kVoucherCobId ||
         id == cob_id::kHeartbeat + kGatewayNodeId;
}

}  // namespace

ForeignFrame look_at_foreign(const CanFrame& frame, const std::deque<NodeLink>& links) {
  using Kind = ForeignFrame::Kind;
  if (frame.extended || frame.remote) return {};
  if (is_of_a_gateway(frame.id)) return {Kind::kGateway, 0, {}};
  const auto known = [&](std::uint8_t id) {
    return id != 0 &&
           std::any_of(links.begin(), links.end(), [&](const NodeLink& link) { return link.id() == id; });
  };
  if (const std::uint8_t node = cob_id::node_of(frame.id, kRecordCobId); known(node))
    return {Kind::kRecord, node,
            say("another device has sent node %1 a record of motion (COB-ID %2)", static_cast<int>(node),
                printed("%03Xh", static_cast<unsigned>(frame.id)))};
  if (const std::uint8_t node = cob_id::node_of(frame.id, cob_id::kSdoRequest);
      known(node) && sdo::begins_to_write(frame))
    return {Kind::kWrite, node,
            say("another device writes object %2 of node %1 while the machine moves", static_cast<int>(node),
                printed("%04Xh:%u", static_cast<unsigned>(get_u16_le(std::span(frame.data).subspan(1))),
                        static_cast<unsigned>(frame.data[3])))};
  return {};
}

}  // namespace kinebus
