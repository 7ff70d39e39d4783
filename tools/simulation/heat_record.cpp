#include "tools/simulation/heat_record.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulation/bus/virtual_machine.hpp"

namespace kinebus {
namespace {
// As often as nodes tell of heat.
constexpr BusTime kLook = std::chrono::milliseconds{100};
}  // namespace

HeatRecord::HeatRecord(const MachineDescription& machine, NodeMachine& nodes) : checker_(machine) {
  for (std::size_t j = 0; j < machine.joints.size(); ++j)
    if (machine.joints[j].name == "E") extruder_ = j;
  for (std::size_t n = 0; n < machine.nodes.size(); ++n) {
    const NodeDescription& node = machine.nodes[n];
    if (node.functions.has_axes() || !machine.carries_heat(node.id)) continue;
    if (heat::HeatPlant* const plant = nodes.heated(static_cast<int>(n)))
      blocks_ = [plant] { return Blocks{plant->hot_end().block(), plant->bed().block()}; };
  }
}

void HeatRecord::on_sample(double job_s, const Sample& sample, const Gateway& gateway) {
  if (sample.time >= next_look_) {
    next_look_ = sample.time + kLook;
    const MachineStatus status = gateway.status();
    target_c_ = status.heater(status.tool).target_celsius;
    for (std::size_t i = 0; i < std::min(status.heaters.size(), PlotData::kHeaters); ++i) {
      const HeaterStatus& heater = status.heaters[i];
      heat_.target_c[i] = static_cast<float>(heater.target_celsius);
      heat_.measured_c[i] = static_cast<float>(heater.actual_celsius);
      heat_.power[i] = static_cast<float>(heater.power.value_or(0));
    }
    for (std::size_t i = 0; i < std::min(status.fans.size(), PlotData::kFans); ++i)
      heat_.fan[i] = static_cast<float>(status.fans[i].ratio);
  }
  if (!blocks_) return;
  const Blocks blocks = blocks_();
  const bool fed_before = checker_.has_fed();
  checker_.on_sample(job_s, blocks, extruder_ ? sample.joints[*extruder_] : 0);
  if (!checker_.feeds()) return;
  if (!fed_before) {
    report_.fed_from_s = job_s;
    report_.bed_c = blocks.bed_c;
  }
  report_.worst_k = std::max(report_.worst_k, std::abs(blocks.hot_end_c - target_c_));
}

std::optional<HeatReport> HeatRecord::report() const {
  if (!blocks_) return std::nullopt;
  HeatReport report = report_;
  report.hottest_c = checker_.hottest_c();
  report.nearest_k = checker_.nearest_k();
  report.fed = checker_.has_fed();
  report.coldest_fed_c = checker_.coldest_c();
  return report;
}

}  // namespace kinebus
