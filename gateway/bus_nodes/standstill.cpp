#include "gateway/bus_nodes/standstill.hpp"

#include <algorithm>
#include <utility>

#include "protocol/canopen/node_objects.hpp"

namespace kinebus {

Standstill::Standstill(const MachineDescription& machine, std::deque<NodeLink>& links)
    : machine_(machine), links_(links), nodes_(links.size()) {}

void Standstill::start(PathTime tau) {
  busy_ = true;
  equal_ = false;
  tau_ = tau;
  for (NodeLink& link : links_) {
    if (!link.functions().has_axes()) continue;
    SdoChannel& sdo = link.sdo();
    sdo.abandon();
    // Of a homing that did not come to its end.
    if (link.reports()) link.set_report_period({});
    sdo.write({object::kBufferClear, 1, 0});
    for (std::uint16_t axis = 0; axis < kAxesPerNode; ++axis)
      for (const ObjectAddress base : {object::kPositionKnown, object::kStreamPosition})
        sdo.read(on_axis(base, axis));
    sdo.read(object::kStreamStatus);
    sdo.read(object::kPathTime);
  }
}

void Standstill::abort() {
  if (!busy_) return;
  busy_ = false;
  for (NodeLink& link : links_)
    if (link.functions().has_axes()) link.sdo().abandon();
}

Standstill::Outcome Standstill::on_time() {
  if (!busy_) return Outcome::kDone;
  bool idle = true;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (!links_[i].functions().has_axes()) continue;
    SdoChannel& sdo = links_[i].sdo();
    while (const auto answer = sdo.next_result()) {
      if (answer->abort != AbortCode::kNone) {
        failure_ = {answer->abort == AbortCode::kTimeout ? AlarmCode::kNodeMissing : AlarmCode::kStreamLost,
                    links_[i].id(), to_string(links_[i].id(), *answer)};
        abort();
        return Outcome::kFailed;
      }
      if (!answer->read) continue;
      if (answer->address == object::kPathTime) {
        nodes_[i].found = PathTime{answer->value};
        continue;
      }
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
  for (NodeLink& link : links_) link.reports_ended();
  if (!std::exchange(equal_, true)) {
    // A node that was not told of a change of rate, or all of them, rest elsewhere than the gateway believes.
    bool same = true;
    for (std::size_t i = 0; i < links_.size(); ++i)
      same = same && (!links_[i].functions().has_axes() || nodes_[i].found == tau_);
    if (!same) {
      for (NodeLink& link : links_)
        if (link.functions().has_axes()) link.sdo().write({object::kPathTime, 8, tau_.count()});
      return Outcome::kBusy;
    }
  }
  busy_ = false;
  return Outcome::kDone;
}

PathTime Standstill::path_time() const {
  PathTime least = PathTime::max();
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (links_[i].functions().has_axes()) least = std::min(least, nodes_[i].found);
  return least;
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
