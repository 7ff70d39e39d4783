#pragma once
// Jerk of every joint against its limit, from positions alone: the planned pose at instants a millisecond
// apart, through the exact inverse kinematics, at the rates of path time that the frames on the bus command.
// Differences of true motor positions would show microsteps.

#include <functional>
#include <optional>
#include <string>

#include "gateway/description/machine_description.hpp"
#include "gateway/machine/gateway.hpp"
#include "protocol/motion/path_clock.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

class JerkChecker {
 public:
  using Planned = std::function<std::optional<PlannedPose>(PathTime)>;
  JerkChecker(const MachineDescription& machine, const Kinematics& kinematics, Planned planned);

  void on_frame(BusTime when, const CanFrame& frame);
  /// Also while the rate changes; a stop has limits of its own.
  void on_sample(const Sample& sample);
  /// 0 where the machine has no limit.
  double max_ratio() const { return max_ratio_; }
  double worst_time_s() const { return worst_time_s_; }
  /// While path time does not run at its full rate.
  double max_ramp_ratio() const { return max_ramp_ratio_; }
  std::string worst_joint() const;

 private:
  bool joints_at(double ticks, JointVector& q) const;

  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  Planned planned_;
  bool limited_ = false;
  JointVector limits_{};
  double max_ratio_ = 0, max_ramp_ratio_ = 0, worst_time_s_ = 0;
  PathClock clock_;
  int worst_joint_ = -1;
};

}  // namespace kinebus
