#include "tools/cli/encoder_rows.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace kinebus {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string words;
  for (const std::string& name : names) words += (words.empty() ? "" : ", ") + name;
  return words;
}

}  // namespace

const joblink::AxisStatus* axis_of(const joblink::Status& status, const joblink::Joint& joint) {
  const auto node = std::find_if(status.nodes().begin(), status.nodes().end(),
                                 [&](const joblink::NodeStatus& n) { return n.id() == joint.node(); });
  const int axis = static_cast<int>(joint.axis());
  return node == status.nodes().end() || axis >= node->axes_size() ? nullptr : &node->axes(axis);
}

EncoderRows encoder_rows(const joblink::Status& status, const joblink::MachineInfo& machine) {
  EncoderRows rows;
  for (int i = 0; i < std::min(machine.joints_size(), status.joints_size()); ++i) {
    const joblink::Joint& joint = machine.joints(i);
    const joblink::AxisStatus* axis = axis_of(status, joint);
    if (joint.rotary() || axis == nullptr) continue;
    double measured_mm = 0;
    if (axis->has_by_scale_mm()) {
      rows.by_scale.push_back(joint.name());
      measured_mm = axis->by_scale_mm();
    } else if (joint.has_scale()) {
      rows.silent.push_back(joint.name());
      continue;
    } else if (axis->has_off_course()) {
      rows.by_encoder.push_back(joint.name());
      measured_mm = status.joints(i) - axis->off_course();
    } else {
      continue;
    }
    std::array<char, 80> numbers{};
    std::snprintf(numbers.data(), numbers.size(), ",%.5f,%.5f\n", status.joints(i), measured_mm);
    rows.csv += joint.name() + numbers.data();
  }
  return rows;
}

std::string source_words(const EncoderRows& rows) {
  std::string words;
  if (!rows.by_scale.empty())
    words += "# measured by linear scales on the rails: " + listed(rows.by_scale) + "\n";
  if (!rows.by_encoder.empty())
    words += "# measured by encoders on the motors' shafts: " + listed(rows.by_encoder) +
             "\n# An error of screw or belt is not in these readings: that takes [joint.NAME.scale].\n";
  return words;
}

}  // namespace kinebus
