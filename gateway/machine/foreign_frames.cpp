#include "gateway/machine/foreign_frames.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/canopen/sdo.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/voucher.hpp"

namespace kinebus {
namespace {

/// RPDO3 of node n, and RPDO4.
constexpr std::uint32_t kRecordCobId = cob_id::rpdo(3, 0), kCheckpointCobId = cob_id::rpdo(4, 0);

bool is_of_a_gateway(std::uint32_t id) {
  return id == cob_id::kSync || id == kRateCobId || id == kSyncStampCobId || id == kVoucherCobId ||
         id == cob_id::kHeartbeat + kGatewayNodeId;
}

/// Of a drive whose motor keeps its current.
bool enables(std::uint16_t controlword) {
  return (controlword & 0x0F) == 0x0F;
}

/// A motor may lose its current by it, be it for a moment only that no statusword tells of.
bool frees_motors(const CanFrame& frame, const NodeLink& link) {
  if (!link.functions().has_axes()) return false;
  const auto word_at = [&](std::size_t place) { return get_u16_le(std::span(frame.data).subspan(place)); };
  if (cob_id::node_of(frame.id, cob_id::rpdo(1, 0)) != 0)
    return frame.length >= 4 && !(enables(word_at(0)) && enables(word_at(2)));
  const std::uint16_t index = sdo::address_in(frame).index;
  constexpr std::uint16_t kControlwordB = object::kControlword.index + 0x800;
  return (index == object::kControlword.index || index == kControlwordB) && !enables(word_at(4));
}

}  // namespace

ForeignFrame look_at_foreign(const CanFrame& frame, const std::deque<NodeLink>& links) {
  using Kind = ForeignFrame::Kind;
  if (frame.extended || frame.remote) return {};
  if (is_of_a_gateway(frame.id)) return {Kind::kGateway, 0, {}};
  const auto link_of = [&](std::uint8_t id) {
    return std::find_if(links.begin(), links.end(), [&](const NodeLink& link) { return link.id() == id; });
  };
  const auto known = [&](std::uint8_t id) { return id != 0 && link_of(id) != links.end(); };
  const auto at_rest = [&](std::uint8_t id) {
    return frees_motors(frame, *link_of(id)) ? ForeignFrame::AtRest::kFreesMotors
                                             : ForeignFrame::AtRest::kNothing;
  };
  for (const std::uint32_t cob_id : {kRecordCobId, kCheckpointCobId})
    if (const std::uint8_t node = cob_id::node_of(frame.id, cob_id); known(node))
      return {Kind::kRecord, node,
              say("another device has sent node %1 a record of motion (COB-ID %2)", static_cast<int>(node),
                  printed("%03Xh", static_cast<unsigned>(frame.id)))};
  if (const std::uint8_t node = cob_id::node_of(frame.id, cob_id::kSdoRequest);
      known(node) && sdo::begins_to_write(frame))
    return {Kind::kOrder, node,
            say("another device writes object %2 of node %1 while the machine moves", static_cast<int>(node),
                printed("%04Xh:%u", static_cast<unsigned>(get_u16_le(std::span(frame.data).subspan(1))),
                        static_cast<unsigned>(frame.data[3]))),
            std::uint64_t{frame.id} << 32 | (get_u32_le(frame.data) >> 8), at_rest(node)};
  if (frame.id == cob_id::kNmt && frame.length == 2 && (frame.data[1] == kAllNodes || known(frame.data[1])))
    return {Kind::kOrder, frame.data[1],
            frame.data[1] == kAllNodes
                ? say("another device has sent all nodes an NMT command (%1)",
                      printed("%02Xh", static_cast<unsigned>(frame.data[0])))
                : say("another device has sent node %1 an NMT command (%2)", static_cast<int>(frame.data[1]),
                      printed("%02Xh", static_cast<unsigned>(frame.data[0]))),
            get_u16_le(frame.data)};
  for (const int rpdo : {1, 2})
    if (const std::uint8_t node = cob_id::node_of(frame.id, cob_id::rpdo(rpdo, 0)); known(node))
      return {Kind::kOrder, node,
              say("another device has sent node %1 a controlword or set point (COB-ID %2)",
                  static_cast<int>(node), printed("%03Xh", static_cast<unsigned>(frame.id))),
              std::uint64_t{frame.id} << 32, at_rest(node)};
  if (frame.id == cob_id::kLssRequest)
    return {Kind::kOrder, 0,
            say("another device speaks LSS, which gives nodes their ids (COB-ID %1)",
                printed("%03Xh", static_cast<unsigned>(frame.id))),
            std::uint64_t{frame.id} << 32, ForeignFrame::AtRest::kIsTold};
  return {};
}

bool UselessFrames::are_many(BusTime now) {
  if (now >= since_ + kPeriod) {
    since_ = now;
    count_ = 0;
  }
  return ++count_ == kMany && !std::exchange(told_, true);
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
