#include "gateway/motors/scale_readings.hpp"

#include <optional>

#include "protocol/canopen/node_objects.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

// A question to each node: with two nodes 0.6 % of the bus, and four scales are known in 0.4 s.
constexpr BusTime kScalePeriod = 100ms;

}  // namespace

ScaleReadings::ScaleReadings(const MachineDescription& machine, const std::vector<NodeAxes>& axes) {
  for (std::size_t node = 0; node < axes.size(); ++node)
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
      const int joint = axes[node].axes[axis].joint;
      if (joint < 0) continue;
      const JointDescription& j = machine.joints[static_cast<std::size_t>(joint)];
      if (!j.scale || !j.homing) continue;
      scales_.push_back({.node = node,
                         .axis = axis,
                         .counts_per_mm = j.scale->pulses_per_mm,
                         .at_home_mm = j.homing->switch_position + j.calibration.offset});
    }
}

void ScaleReadings::take(std::size_t node, const SdoResult& answer) {
  const bool home = answer.address.subindex == object::kScaleHomeLatch.subindex;
  for (Scale& scale : scales_) {
    const ObjectAddress wanted = on_axis(home ? object::kScaleHomeLatch : object::kScalePosition, scale.axis);
    // One that was asked for before a motion says nothing of the place after it.
    if (scale.node != node || wanted != answer.address || !scale.asked) continue;
    std::optional<std::int64_t>& reading = home ? scale.home : scale.counts;
    if (answer.abort == AbortCode::kNone)
      reading = answer.value;
    else
      scale.home.reset(), scale.counts.reset();  // it has fallen silent, and knows no more where home was
  }
}

void ScaleReadings::on_time(BusTime now, std::deque<NodeLink>& links, bool rests, bool may_ask) {
  if (scales_.empty()) return;
  if (!rests)
    for (Scale& scale : scales_) {
      scale.home.reset(), scale.counts.reset();
      scale.asked = false;
    }
  for (std::size_t node = 0; node < links.size(); ++node)
    for (const ObjectAddress base : {object::kScaleHomeLatch, object::kScalePosition})
      while (const auto answer = links[node].sdo().next_glance(base)) take(node, *answer);
  if (!rests || !may_ask || now < due_) return;
  for (std::size_t i = 0; i < scales_.size(); ++i) {
    Scale& scale = scales_[(first_ + i) % scales_.size()];
    NodeLink& link = links[scale.node];
    if (!link.heard() || !link.sdo().idle()) continue;
    scale.asked = true;
    link.sdo().glance(on_axis(scale.home ? object::kScalePosition : object::kScaleHomeLatch, scale.axis));
  }
  first_ = (first_ + 1) % scales_.size();
  due_ = now + kScalePeriod;
}

std::optional<double> ScaleReadings::joint_mm(std::size_t node, std::size_t axis) const {
  for (const Scale& scale : scales_)
    if (scale.node == node && scale.axis == axis && scale.home && scale.counts)
      return scale.at_home_mm + static_cast<double>(*scale.counts - *scale.home) / scale.counts_per_mm;
  return std::nullopt;
}

}  // namespace kinebus
