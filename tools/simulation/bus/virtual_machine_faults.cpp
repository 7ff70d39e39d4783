// What befalls the nodes of the virtual machine from outside.

#include <algorithm>
#include <span>
#include <utility>

#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "tools/simulation/bus/virtual_machine.hpp"
#include "tools/simulation/bus/virtual_machine_node.hpp"

namespace kinebus {

void VirtualMachine::set_power(int node, BusTime now, bool on) {
  VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  if (on == n.powered()) return;
  n.pending.clear();
  n.edges.clear();
  n.stalled = false;
  n.lost_while_stalled = 0;
  if (!on) {
    for (int axis = 0; axis < 2; ++axis)
      n.options.axes[static_cast<std::size_t>(axis)].start_counts = n.counts(axis, now);
    n.core.reset();
    n.heat.reset();
    bus_.clear(n.port);
    n.next_check = BusTime::max();
    return;
  }
  n.switch_on(now);
  n.switch_level = {-1, -1};
  n.next_check = now;
  probe_touches_.reset();
  serve(n, now);
}

void VirtualMachine::set_stalled(int node, BusTime now, bool stalled) {
  VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  if (!n.core || n.stalled == stalled) return;
  n.stalled = stalled;
  // Its interrupts went on, of frames as of switches: the time stamps are right.
  if (!stalled) {
    const auto later = std::find_if(n.edges.begin(), n.edges.end(),
                                    [now](const VirtualNode::RawEdge& edge) { return edge.at > now; });
    for (auto edge = n.edges.begin(); edge != later; ++edge)
      n.core->on_switch(n.to_local(edge->at), edge->input - 1, edge->level);
    n.edges.erase(n.edges.begin(), later);
    for (Pending& p : n.pending) p.at = std::max(p.at, now);
    n.core->on_time(n.to_local(now));
  }
  if (stalled) return;
  n.deadline = std::max(n.deadline, now);
  count_overruns(node, now, std::exchange(n.lost_while_stalled, 0u));
}

void VirtualMachine::set_drive_fault(int node, BusTime now, int axis, bool present) {
  VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  if (!n.core) return;
  if (present)
    n.core->on_drive_fault(n.to_local(now), axis, 0x2310);
  else
    n.core->on_drive_fault_gone(n.to_local(now), axis);
  serve(n, now);
}

void VirtualMachine::count_overruns(int node, BusTime now, std::uint32_t times) {
  VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  if (!n.core || times == 0) return;
  n.core->on_receive_overrun(n.to_local(now), times);
  serve(n, now);
}

void VirtualMachine::write_parameter(int node, BusTime now, ObjectAddress address, int size,
                                     std::uint32_t value) {
  VirtualNode& n = *nodes_[static_cast<std::size_t>(node)];
  if (!n.core) return;
  CanFrame request{.id = cob_id::kSdoRequest + n.core->node_id(), .length = 8};
  request.data[0] = static_cast<std::uint8_t>(0x23 | ((4 - size) << 2));
  put_u16_le(std::span(request.data).subspan(1), address.index);
  request.data[3] = address.subindex;
  put_u32_le(std::span(request.data).subspan(4), value);
  n.core->on_frame(n.to_local(now), request);
  // Its answer was for another gateway.
  while (n.core->next_frame()) {
  }
}

void VirtualMachine::lose_steps(int node, int axis, double counts) {
  nodes_[static_cast<std::size_t>(node)]->options.axes[static_cast<std::size_t>(axis)].start_counts += counts;
}

}  // namespace kinebus
