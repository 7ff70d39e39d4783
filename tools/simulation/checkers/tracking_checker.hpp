#pragma once
// The tool against the planned pose at equal path time, and every joint against q(tau) of its own node's path
// time.

#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "gateway/description/machine_description.hpp"
#include "gateway/machine/gateway.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

class TrackingChecker {
 public:
  using Planned = std::function<std::optional<PlannedPose>(PathTime)>;
  TrackingChecker(const MachineDescription& machine, const Kinematics& kinematics, Planned planned)
      : machine_(machine), kinematics_(kinematics), planned_(std::move(planned)) {}

  void on_sample(const Sample& sample);

  double max_tool_um() const { return max_tool_um_; }
  double rms_tool_um() const {
    return tools_ > 0 ? std::sqrt(tool_squares_um2_ / static_cast<double>(tools_)) : 0;
  }
  /// Largest distance of a motor from q(tau), in its own microsteps.
  double max_joint_counts() const { return max_joint_counts_; }
  int worst_joint() const { return worst_joint_; }
  double worst_joint_time_s() const { return worst_joint_time_s_; }
  double last_tool_um() const { return last_tool_um_; }
  double worst_time_s() const { return worst_time_s_; }
  std::uint32_t worst_line() const { return worst_line_; }
  std::uint64_t samples() const { return samples_; }

 private:
  void check_tool(const Sample& sample);
  void check_joints(const Sample& sample);

  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  Planned planned_;
  double tool_squares_um2_ = 0;
  std::uint64_t tools_ = 0;
  double max_tool_um_ = 0, max_joint_counts_ = 0, last_tool_um_ = 0, worst_time_s_ = 0,
         worst_joint_time_s_ = 0;
  int worst_joint_ = -1;
  std::uint32_t worst_line_ = 0;
  std::uint64_t samples_ = 0;
};

}  // namespace kinebus
