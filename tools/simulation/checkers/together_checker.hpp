#pragma once
// Carriages in step: path time equal on all nodes that live, at random instants, through every ramp; and the
// tool on the planned path at that common path time, whether the job runs, stops or goes on.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "gateway/description/machine_description.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

class TogetherChecker {
 public:
  using Planned = std::function<std::optional<PlannedPose>(PathTime)>;
  /// Which nodes count: those with power, that have not been restarted since the job began.
  using Lives = std::array<bool, kMaxNodes>;
  /// Joints whose node says that it knows where they are. One whose motor was let go is nowhere.
  using Known = std::array<bool, std::tuple_size_v<JointVector>>;

  TogetherChecker(const MachineDescription& machine, const Kinematics& kinematics, Planned planned)
      : machine_(machine), kinematics_(kinematics), planned_(std::move(planned)) {}

  void on_probe(const Probe& probe, const Lives& lives) {
    std::int64_t low = INT64_MAX, high = INT64_MIN;
    for (std::size_t n = 0; n < static_cast<std::size_t>(probe.node_count); ++n) {
      if (!lives[n]) continue;
      low = std::min(low, probe.tau[n].count());
      high = std::max(high, probe.tau[n].count());
    }
    if (low > high) return;
    const double us = static_cast<double>(high - low) / 16;
    if (us > skew_us_) skew_us_ = us, skew_time_s_ = to_seconds(probe.time);
  }

  /// All live and known: distance of the tool from the plan. Else: of the worst carriage that is. `astray`: a
  /// motor has lost steps, which no node can see; counted by itself.
  void on_sample(const Sample& sample, const Lives& lives, const Known& known, bool astray) {
    std::int64_t sum = 0;
    int count = 0;
    for (std::size_t n = 0; n < static_cast<std::size_t>(sample.node_count); ++n)
      if (lives[n]) sum += (sample.node_tau[n] - sample.node_tau[0]).count(), ++count;
    if (count == 0) return;
    const auto planned = planned_(sample.node_tau[0] + PathTime{sum / count});
    JointVector q{};
    if (!planned || !kinematics_.inverse(planned->frame, planned->pose, q)) return;
    double worst = 0;
    bool whole = count == sample.node_count;
    for (std::size_t j = 0; j < machine_.joints.size(); ++j) whole = whole && known[j];
    if (whole) {
      Pose pose = sample.pose;
      if (!kinematics_.forward(Frame::kPart, q, pose)) return;
      for (const PoseAxis axis : {kX, kY, kZ}) worst += std::pow(sample.pose[axis] - pose[axis], 2);
      worst = std::sqrt(worst);
    } else {
      for (std::size_t j = 0; j < machine_.joints.size(); ++j)
        if (!machine_.joints[j].rotary && known[j] && lives[node_of(j)])
          worst = std::max(worst, std::abs(sample.joints[j] - q[j]));
    }
    if (1000 * worst > kFar_um) ++far_samples_;
    if (astray) astray_um_ = std::max(astray_um_, 1000 * worst);
    if (!astray && 1000 * worst > path_um_) path_um_ = 1000 * worst, path_time_s_ = to_seconds(sample.time);
  }

  double skew_us() const { return skew_us_; }
  double skew_time_s() const { return skew_time_s_; }
  double path_um() const { return path_um_; }
  /// Samples in which the tool was farther off than kFar_um.
  int far_samples() const { return far_samples_; }
  static constexpr double kFar_um = 5;
  double astray_um() const { return astray_um_; }
  double path_time_s() const { return path_time_s_; }

 private:
  std::size_t node_of(std::size_t joint) const {
    for (std::size_t n = 0; n < machine_.nodes.size(); ++n)
      if (machine_.nodes[n].id == machine_.joints[joint].node_id) return n;
    return 0;
  }

  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  Planned planned_;
  double skew_us_ = 0, skew_time_s_ = 0, path_um_ = 0, path_time_s_ = 0, astray_um_ = 0;
  int far_samples_ = 0;
};

}  // namespace kinebus
