#pragma once
// No velocity step ever reaches a motor: neither at power-up, enabling, homing, start and stop, nor when
// clocks are corrected. Measured by differences of the true positions, all the time.

#include <array>
#include <string>

#include "gateway/description/machine_description.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

class StepChecker {
 public:
  explicit StepChecker(const MachineDescription& machine) : machine_(machine) {}

  /// A board without power leaves its motors where they are: bit n of `dead_nodes` excuses node n.
  void on_sample(const Sample& sample, unsigned dead_nodes = 0);

  /// Largest change of velocity from one millisecond to the next, over what the joint's stated stop limit
  /// allows in that time.
  double max_ratio() const { return max_ratio_; }
  double worst_time_s() const { return worst_time_s_; }
  std::string worst_joint() const;

 private:
  const MachineDescription& machine_;
  std::array<JointVector, 2> before_{};
  BusTime last_{0};
  int in_a_row_ = 0;
  double max_ratio_ = 0, worst_time_s_ = 0;
  int worst_joint_ = -1;
};

}  // namespace kinebus
