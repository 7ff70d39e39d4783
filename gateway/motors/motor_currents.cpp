#include "gateway/motors/motor_currents.hpp"

#include "protocol/canopen/node_objects.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

// A request and its answer every 100 ms: 0.3 % of the bus, and six axes in 0.6 s.
constexpr BusTime kGlancePeriod = 100ms;
constexpr BusTime kOldestGlance = 3s;
// A temperature changes slowly: every fourth request is for one.
constexpr std::size_t kCurrentsATemperature = 4;
constexpr BusTime kOldestTemperature = 30s;

}  // namespace

void MotorCurrents::on_time(BusTime now, std::deque<NodeLink>& links, const std::vector<NodeAxes>& axes,
                            bool may_ask) {
  for (std::size_t i = 0; i < links.size(); ++i)
    for (const ObjectAddress base : {object::kMotorCurrent, object::kStageTemperature})
      while (const auto answer = links[i].sdo().next_glance(base)) take(now, read_[i], *answer);
  if (!may_ask || now >= until_ || now < due_) return;
  const bool warm = turns_ % kCurrentsATemperature == kCurrentsATemperature - 1;
  const ObjectAddress base = warm ? object::kStageTemperature : object::kMotorCurrent;
  std::size_t& next = warm ? next_warm_ : next_;
  for (std::size_t tried = 0; tried < kAxesPerNode * axes.size(); ++tried) {
    const std::size_t node = next / kAxesPerNode, axis = next % kAxesPerNode;
    next = (next + 1) % (kAxesPerNode * axes.size());
    SdoChannel& sdo = links[node].sdo();
    if (axes[node].axes[axis].joint < 0 || !links[node].heard() || !sdo.idle()) continue;
    sdo.glance(on_axis(base, axis));
    ++turns_;
    due_ = now + kGlancePeriod;
    return;
  }
}

void MotorCurrents::take(BusTime now, Read& read, const SdoResult& answer) {
  if (answer.abort != AbortCode::kNone) return;
  const std::size_t axis = answer.address.index >= object::kMotorCurrent.index + kAxisOffset ? 1 : 0;
  if (answer.address.subindex == object::kMotorCurrent.subindex) {
    read.amperes[axis] = static_cast<double>(answer.value) * 1e-3;
    read.when[axis] = now;
  } else {
    read.celsius[axis] = static_cast<double>(answer.value) * 0.1;
    read.warm_when[axis] = now;
  }
}

std::optional<double> MotorCurrents::amperes(std::size_t node, std::size_t axis, BusTime now) const {
  const Read& read = read_[node];
  if (!read.when[axis] || now - *read.when[axis] > kOldestGlance) return std::nullopt;
  return read.amperes[axis];
}

std::optional<double> MotorCurrents::celsius(std::size_t node, std::size_t axis, BusTime now) const {
  const Read& read = read_[node];
  // A node without a sensor says 0.
  const bool known = read.warm_when[axis] && now - *read.warm_when[axis] <= kOldestTemperature;
  if (!known || read.celsius[axis] == 0) return std::nullopt;
  return read.celsius[axis];
}

}  // namespace kinebus
