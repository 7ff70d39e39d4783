#pragma once
// A position is known or declared unknown, never wrong: what a node that says "known" believes, against where
// its carriage stands; and what the gateway shows, when it says that positions are known.

#include <algorithm>
#include <cmath>
#include <string>

#include "gateway/description/machine_description.hpp"
#include "gateway/status/status.hpp"
#include "tools/simulation/bus/virtual_machine.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

class KnownChecker {
 public:
  explicit KnownChecker(const MachineDescription& machine) : machine_(machine) {}

  /// Nodes: at any time. `excused`: its motor has lost steps, which no node can see before the next homing.
  void on_nodes(VirtualMachine& machine, BusTime now, double excused_counts) {
    for (const JointDescription& joint : machine_.joints) {
      if (!joint.homing) continue;
      int node = 0;
      for (std::size_t n = 0; n < machine_.nodes.size(); ++n)
        if (machine_.nodes[n].id == joint.node_id) node = static_cast<int>(n);
      const auto believed = machine.believed_counts(node, joint.axis, now);
      if (!believed) continue;
      const double off = std::abs(*believed - machine.true_counts(node, joint.axis, now)) - excused_counts;
      if (off > worst_counts_) {
        worst_counts_ = off;
        worst_ = joint.name;
        worst_time_s_ = to_seconds(now);
      }
    }
  }
  /// The gateway: at rest.
  void on_gateway(const MachineStatus& status, const Sample& sample, double excused_counts) {
    if (!status.positions_known) return;
    for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
      const JointDescription& joint = machine_.joints[j];
      if (!joint.homing) continue;
      const double counts = std::abs((status.joints[j] - sample.joints[j]) * joint.drive.counts_per_unit());
      if (counts - excused_counts > worst_shown_counts_) {
        worst_shown_counts_ = counts - excused_counts;
        worst_shown_time_s_ = to_seconds(sample.time);
      }
    }
  }

  double worst_counts() const { return worst_counts_; }
  double worst_shown_counts() const { return worst_shown_counts_; }
  double worst_time_s() const { return worst_time_s_; }
  double worst_shown_time_s() const { return worst_shown_time_s_; }
  const std::string& worst() const { return worst_; }

 private:
  const MachineDescription& machine_;
  double worst_counts_ = 0, worst_shown_counts_ = 0, worst_time_s_ = 0, worst_shown_time_s_ = 0;
  std::string worst_;
};

}  // namespace kinebus
