// What a node does with a frame: whom it obeys, SYNC, NMT and LSS.

#include <algorithm>

#include "node_firmware/core/emergency_codes.hpp"
#include "node_firmware/core/node.hpp"

namespace kinebus {

void Node::on_frame(LocalTime at, const CanFrame& frame) {
  now_ = std::max(now_, at);
  serve();
  if (!obeys(frame)) return serve();
  if (NodeGuard::asks(frame, node_id_) && answers_guarding()) {
    guard_.on_request(now_);
    return serve();
  }
  const SyncReception sync = decode_sync(
      frame, cob_id::kSync, static_cast<std::uint8_t>(objects_.value(slot_of(object::kSyncCounterOverflow))));
  if (sync.is_sync) {
    if (!sync.length_error) path_.on_sync(sync.counter, at);
    on_sync(sync);
  } else if (frame.id == cob_id::kLssRequest) {
    if (!options_.id_from_board && !in_motion() && lss_.on_frame(frame)) on_lss();
  } else if (const auto command = nmt_.on_frame(frame)) {
    on_nmt(*command);
  } else if (nmt_.state() != NmtState::kInitialising) {
    path_.on_peer_emcy(frame, now_);
    const bool news = watched_.on_frame(now_, frame).has_value();
    if (nmt_.allows_sdo()) sdo_.on_frame(now_, frame);
    const bool pdo = pdo_.on_frame(now_, frame) != PdoEngine::Reception::kNotMine;
    // Of a frame that is for others nothing follows, and on a full bus most are.
    const bool emcy = cob_id::node_of(frame.id, cob_id::kEmcy) != 0;
    if (!news && !pdo && !emcy && frame.id != cob_id::kSdoRequest + node_id_) return;
  }
  serve();
}

// What all nodes of a gateway hear at once, told to one of them alone, would move its carriages apart from
// the others'.
bool Node::parts_from_others(const CanFrame& frame) const {
  if (frame.id != cob_id::kSdoRequest + node_id_ || !path_.clock().synchronised()) return false;
  const ObjectAddress address = sdo::address_in(frame);
  return sdo::begins_to_write(frame) && (address == object::kRateCommand || address == object::kSyncStamp ||
                                         address == object::kSegmentRecord || address == object::kCheckpoint);
}

bool Node::obeys(const CanFrame& frame) {
  auto answer = session_.judge(frame, node_id_, session_.has_key() && in_motion());
  if (answer == SessionGuard::Answer::kObey && parts_from_others(frame))
    answer = SessionGuard::Answer::kRefuse;
  if (answer == SessionGuard::Answer::kRefuse && nmt_.allows_sdo()) sdo_.refuse(frame);
  return answer == SessionGuard::Answer::kObey;
}

void Node::on_sync(const SyncReception& sync) {
  if (!nmt_.allows_sync()) return;
  if (sync.length_error) {
    count(NodeCounter::kRxMalformed);
    // Before the start its master may not have come to 1019h yet.
    if (nmt_.allows_pdo() && !emcy_.active(emcy::kSyncLength)) emcy_.raise(emcy::kSyncLength);
    return;
  }
  // What synchronous RPDOs brought since the last SYNC is what the axes start for now.
  pdo_.on_sync(now_, sync.counter);
  for (DriveAxis& axis : axes_) axis.on_sync(now_);
}

void Node::on_lss() {
  if (lss_.take_store_request()) {
    if (board_powered()) return lss_.refuse_store();
    const std::uint8_t id = lss_.pending_node_id();
    image_.set_node_id(id == kUnconfiguredNodeId ? std::uint8_t{0} : id);
    storing_ = Storing::kWanted;
    storing_for_lss_ = true;
  }
  if (const auto id = lss_.take_node_id()) {
    node_id_ = *id;
    boot();
  }
}

void Node::on_nmt(NmtCommand command) {
  const bool starts = command == NmtCommand::kStart;
  const bool streams = !path_.at_rest(now_) && !path_.stream().idle();
  const bool together = streams || (path_.clock().synchronised() && moving(now_));
  // Without PDOs the stream would starve, and a carriage that homes goes its way unseen; all others stop with
  // this node, at once. A drive that has no gateway does what its 6007h says.
  if (!starts && together && !path_.stop_latched())
    path_.request_stop(StopReason::kCommand, 0, node_emcy::kCommand, now_);
  if (!starts && !together)
    for (DriveAxis& axis : axes_) axis.on_connection_lost(now_);
  switch (command) {
    case NmtCommand::kStart:
      emcy_.clear(emcy::kSyncLength);
      emcy_.clear(emcy::kPdoRefused);
      emcy_.clear(emcy::kPdoTooShort);
      emcy_.clear(emcy::kPdoTooLong);
      break;
    case NmtCommand::kResetNode:
      for (DriveAxis& axis : axes_) axis.on_reset(now_);
      reset_requested_ = true;
      [[fallthrough]];
    case NmtCommand::kResetCommunication:
      session_.end();
      serve_emergencies();
      lss_.activate();
      node_id_ = lss_.active_node_id() == kUnconfiguredNodeId ? std::uint8_t{0} : lss_.active_node_id();
      command == NmtCommand::kResetNode ? boot() : reset_communication();
      break;
    case NmtCommand::kStop:
    case NmtCommand::kEnterPreOperational:
      break;
  }
  pdo_.set_operational(nmt_.allows_pdo(), now_);
}

}  // namespace kinebus
