#include "tools/cli/encoder_rows.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace kinebus {
namespace {

/// The axis that drives a joint; nullptr: its node is not there.
const joblink::AxisStatus* axis_of(const joblink::Status& status, const joblink::Joint& joint) {
  const auto node = std::find_if(status.nodes().begin(), status.nodes().end(),
                                 [&](const joblink::NodeStatus& n) { return n.id() == joint.node(); });
  const int axis = static_cast<int>(joint.axis());
  return node == status.nodes().end() || axis >= node->axes_size() ? nullptr : &node->axes(axis);
}

}  // namespace

std::string encoder_rows(const joblink::Status& status, const joblink::MachineInfo& machine) {
  std::string rows;
  for (int i = 0; i < std::min(machine.joints_size(), status.joints_size()); ++i) {
    const joblink::Joint& joint = machine.joints(i);
    const joblink::AxisStatus* axis = axis_of(status, joint);
    if (joint.rotary() || axis == nullptr || !axis->has_off_course()) continue;
    std::array<char, 80> numbers{};
    std::snprintf(numbers.data(), numbers.size(), ",%.5f,%.5f\n", status.joints(i),
                  status.joints(i) - axis->off_course());
    rows += joint.name() + numbers.data();
  }
  return rows;
}

}  // namespace kinebus
