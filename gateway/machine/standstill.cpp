#include "gateway/machine/standstill.hpp"

#include "protocol/canopen/node_objects.hpp"

namespace kinebus {

Standstill::Standstill(const MachineDescription& machine, std::deque<NodeLink>& links)
    : machine_(machine), links_(links), nodes_(links.size()) {}

void Standstill::start() {
  busy_ = true;
  for (NodeLink& link : links_) {
    SdoChannel& sdo = link.sdo();
    sdo.abandon();
    sdo.write({object::kBufferClear, 1, 0});
    for (std::uint16_t axis = 0; axis < kAxesPerNode; ++axis)
      for (const ObjectAddress base : {object::kPositionKnown, object::kStreamPosition})
        sdo.read({static_cast<std::uint16_t>(base.index + axis * kAxisOffset), base.subindex});
    sdo.read(object::kStreamStatus);
  }
}

void Standstill::abort() {
  if (!busy_) return;
  busy_ = false;
  for (NodeLink& link : links_) link.sdo().abandon();
}

Standstill::Outcome Standstill::on_time() {
  if (!busy_) return Outcome::kDone;
  bool idle = true;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    SdoChannel& sdo = links_[i].sdo();
    while (const auto answer = sdo.next_result()) {
      if (answer->abort != AbortCode::kNone) {
        failure_ = {answer->abort == AbortCode::kTimeout ? AlarmCode::kNodeMissing : AlarmCode::kStreamLost,
                    links_[i].id(), to_string(links_[i].id(), *answer)};
        abort();
        return Outcome::kFailed;
      }
      if (!answer->read) continue;
      if (answer->address == object::kStreamStatus) {
        nodes_[i].stream = decode_stream_status(static_cast<std::uint64_t>(answer->value));
        continue;
      }
      const std::size_t axis = answer->address.index >= object::kStreamPosition.index + kAxisOffset ? 1 : 0;
      if (answer->address.subindex == object::kPositionKnown.subindex)
        nodes_[i].known[axis] = answer->value != 0;
      else
        nodes_[i].position[axis] = {answer->value, 0};
    }
    idle = idle && sdo.idle();
  }
  if (!idle) return Outcome::kBusy;
  busy_ = false;
  return Outcome::kDone;
}

bool Standstill::positions_known() const {
  for (const JointDescription& joint : machine_.joints) {
    if (!joint.homing) continue;
    for (std::size_t i = 0; i < links_.size(); ++i)
      if (links_[i].id() == joint.node_id && !nodes_[i].known[joint.axis & 1u]) return false;
  }
  return true;
}

}  // namespace kinebus
