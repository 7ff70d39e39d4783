#pragma once
// Jerk of every joint against its limit, from positions alone: the planned pose at instants a millisecond of
// path time apart, through the exact inverse kinematics. Differences of true motor positions would show
// microsteps.

#include <functional>
#include <optional>
#include <string>

#include "gateway/description/machine_description.hpp"
#include "gateway/machine/gateway.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

class JerkChecker {
 public:
  using Planned = std::function<std::optional<PlannedPose>(PathTime)>;
  JerkChecker(const MachineDescription& machine, const Kinematics& kinematics, Planned planned);

  /// While path time runs at its full rate: ramps of the rate have limits of their own.
  void on_sample(const Sample& sample);
  /// 0 where the machine has no limit.
  double max_ratio() const { return max_ratio_; }
  double worst_time_s() const { return worst_time_s_; }
  std::string worst_joint() const;

 private:
  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  Planned planned_;
  bool limited_ = false;
  JointVector limits_{};
  double max_ratio_ = 0, worst_time_s_ = 0;
  int worst_joint_ = -1;
};

}  // namespace kinebus
