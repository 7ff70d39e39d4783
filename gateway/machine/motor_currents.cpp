#include "gateway/machine/motor_currents.hpp"

#include "protocol/canopen/node_objects.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

// A request and its answer every 100 ms: 0.3 % of the bus, and six axes in 0.6 s.
constexpr BusTime kGlancePeriod = 100ms;
constexpr BusTime kOldestGlance = 3s;

}  // namespace

void MotorCurrents::on_time(BusTime now, std::deque<NodeLink>& links, const std::vector<NodeAxes>& axes,
                            bool may_ask) {
  for (std::size_t i = 0; i < links.size(); ++i)
    while (const auto result = links[i].sdo().next_glance(object::kMotorCurrent)) {
      const std::size_t axis = result->address.index >= object::kMotorCurrent.index + kAxisOffset ? 1 : 0;
      if (result->abort != AbortCode::kNone) continue;
      read_[i].amperes[axis] = static_cast<double>(result->value) * 1e-3;
      read_[i].when[axis] = now;
    }
  if (!may_ask || now >= until_ || now < due_) return;
  for (std::size_t tried = 0; tried < kAxesPerNode * axes.size(); ++tried) {
    const std::size_t node = next_ / kAxesPerNode, axis = next_ % kAxesPerNode;
    next_ = (next_ + 1) % (kAxesPerNode * axes.size());
    SdoChannel& sdo = links[node].sdo();
    if (axes[node].axes[axis].joint < 0 || !links[node].heard() || !sdo.idle()) continue;
    sdo.glance({static_cast<std::uint16_t>(object::kMotorCurrent.index + axis * kAxisOffset),
                object::kMotorCurrent.subindex});
    due_ = now + kGlancePeriod;
    return;
  }
}

std::optional<double> MotorCurrents::amperes(std::size_t node, std::size_t axis, BusTime now) const {
  const Read& read = read_[node];
  if (!read.when[axis] || now - *read.when[axis] > kOldestGlance) return std::nullopt;
  return read.amperes[axis];
}

}  // namespace kinebus
