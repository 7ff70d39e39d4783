#pragma once
// What a simulated job does with heat: by the status for the picture, by the plant for the report.

#include <functional>
#include <optional>
#include <string>

#include "gateway/machine/gateway.hpp"
#include "tools/simulation/bus/node_machine.hpp"
#include "tools/simulation/checkers/heat_checker.hpp"
#include "tools/simulation/plot.hpp"
#include "tools/simulation/report.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

class HeatRecord {
 public:
  /// Blocks are known where `nodes` are virtual ones and one of them is a heat node.
  HeatRecord(const MachineDescription& machine, NodeMachine& nodes);
  void on_sample(double job_s, const Sample& sample, const Gateway& gateway);

  const PlotData::Heat& heat() const { return heat_; }
  std::optional<HeatReport> report() const;
  const std::string& complaint() const { return checker_.complaint(); }

 private:
  std::function<Blocks()> blocks_;       // as they are; empty: nobody knows
  std::optional<std::size_t> extruder_;  // its joint
  HeatChecker checker_;
  PlotData::Heat heat_;
  double target_c_ = 0;  // of the hot end
  BusTime next_look_{0};
  HeatReport report_;
};

}  // namespace kinebus
