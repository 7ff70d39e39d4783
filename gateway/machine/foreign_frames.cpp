#include "gateway/machine/foreign_frames.hpp"

#include <algorithm>

#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/nmt.hpp"
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
    return {Kind::kOrder, node,
            say("another device writes object %2 of node %1 while the machine moves", static_cast<int>(node),
                printed("%04Xh:%u", static_cast<unsigned>(get_u16_le(std::span(frame.data).subspan(1))),
                        static_cast<unsigned>(frame.data[3]))),
            std::uint64_t{frame.id} << 32 | (get_u32_le(frame.data) >> 8)};
  if (frame.id == cob_id::kNmt && frame.length == 2 && (frame.data[1] == kAllNodes || known(frame.data[1])))
    return {Kind::kOrder, frame.data[1],
            frame.data[1] == kAllNodes
                ? say("another device has sent all nodes an NMT command (%1)",
                      printed("%02Xh", static_cast<unsigned>(frame.data[0])))
                : say("another device has sent node %1 an NMT command (%2)", static_cast<int>(frame.data[1]),
                      printed("%02Xh", static_cast<unsigned>(frame.data[0]))),
            get_u16_le(frame.data)};
  if (const std::uint8_t node = cob_id::node_of(frame.id, cob_id::rpdo(1, 0)); known(node))
    return {Kind::kOrder, node,
            say("another device has sent node %1 a controlword or set point (COB-ID %2)",
                static_cast<int>(node), printed("%03Xh", static_cast<unsigned>(frame.id))),
            std::uint64_t{frame.id} << 32};
  return {};
}

bool ForeignOrders::is_news(BusTime now, std::uint64_t order) {
  if (now >= since_ + kPeriod) {
    since_ = now;
    count_ = 0;
  }
  const auto end = told_.begin() + static_cast<std::ptrdiff_t>(count_);
  if (count_ == told_.size() || std::find(told_.begin(), end, order) != end) return false;
  told_[count_++] = order;
  return true;
}

}  // namespace kinebus
