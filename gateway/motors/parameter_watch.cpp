#include "gateway/motors/parameter_watch.hpp"

#include "gateway/bus_nodes/node_configuration.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/node_objects.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// The other device's transfer has ended by then: a node serves one at a time.
constexpr BusTime kAfterRequest = 100ms;
constexpr BusTime kAgain = 600ms;

}  // namespace

ParameterWatch::ParameterWatch(const MachineDescription& machine, std::deque<NodeLink>& links)
    : links_(links) {
  for (const NodeLink& link : links) nodes_.push_back({configure_node(machine, link.id()).fingerprint, {}});
}

void ParameterWatch::on_frame(BusTime when, const CanFrame& frame) {
  if (frame.extended || frame.remote) return;
  const std::uint8_t id = cob_id::node_of(frame.id, cob_id::kSdoRequest);
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (id != 0 && links_[i].id() == id && nodes_[i].expected) nodes_[i].ask = when + kAfterRequest;
}

std::optional<ParameterWatch::Change> ParameterWatch::on_time(BusTime now, bool may_ask) {
  std::optional<Change> change;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    SdoChannel& sdo = links_[i].sdo();
    if (const auto told = sdo.next_glance(object::kFingerprint);
        told && told->abort == AbortCode::kNone && node.expected) {
      const auto found = static_cast<std::uint32_t>(told->value);
      node.ask.reset();
      if (found != *node.expected && may_ask && !links_[i].reports() && !change)
        change = Change{i, found, *node.expected};
    }
    // A node that was told to report its positions has another fingerprint until that is taken back.
    if (!node.ask || !may_ask || links_[i].reports() || now < *node.ask || !sdo.idle()) continue;
    sdo.glance(object::kFingerprint);
    node.ask = now + kAgain;  // unless the answer comes
  }
  return change;
}

void ParameterWatch::changed(const MachineDescription& machine, std::size_t node, BusTime now) {
  nodes_[node] = {configure_node(machine, links_[node].id()).fingerprint, now};
}

void ParameterWatch::forget() {
  for (Node& node : nodes_) node.ask.reset();
}

}  // namespace kinebus
