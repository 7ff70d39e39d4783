#include "tools/simulation/checkers/jerk_checker.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {

JerkChecker::JerkChecker(const MachineDescription& machine, const Kinematics& kinematics, Planned planned)
    : machine_(machine),
      kinematics_(kinematics),
      planned_(std::move(planned)),
      limited_(machine.path.tool_jerk_mm_per_s3 > 0) {
  for (std::size_t j = 0; j < machine.joints.size(); ++j)
    limits_[j] = joint_jerk_limit(machine, machine.joints[j]);
}

std::string JerkChecker::worst_joint() const {
  return worst_joint_ < 0 ? "" : machine_.joints[static_cast<std::size_t>(worst_joint_)].name;
}

void JerkChecker::on_frame(BusTime when, const CanFrame& frame) {
  if (frame.id != kRateCobId || frame.extended) return;
  if (const auto command = decode_rate_command(frame, when)) clock_.apply(*command, when);
}

/// Between whole ticks: a tick at 300 mm/s, differenced three times, is most of a jerk limit.
bool JerkChecker::joints_at(double ticks, JointVector& q) const {
  const PathTime tick{static_cast<std::int64_t>(std::floor(ticks))};
  const double share = ticks - static_cast<double>(tick.count());
  const auto from = planned_(tick), to = planned_(tick + PathTime{1});
  JointVector next{};
  if (!from || !to || !kinematics_.inverse(from->frame, from->pose, q) ||
      !kinematics_.inverse(to->frame, to->pose, next))
    return false;
  for (std::size_t j = 0; j < machine_.joints.size(); ++j) q[j] += share * (next[j] - q[j]);
  return true;
}

void JerkChecker::on_sample(const Sample& sample) {
  constexpr BusTime kStep = std::chrono::milliseconds{1};
  clock_.forget_before(sample.time);
  const double rate = static_cast<double>(clock_.rate_q32(sample.time)) / 4294967296.0;
  // They differ where a stop was asked for by a node.
  constexpr double kSame = 0.02;
  if (!limited_ || !sample.planned || clock_.stop_latched() || std::abs(rate - sample.rate) > kSame) return;
  std::array<JointVector, 4> q{};
  const std::int64_t now = clock_.fine_tau(sample.time);
  for (std::size_t i = 0; i < q.size(); ++i) {
    const std::int64_t back = now - clock_.fine_tau(sample.time - static_cast<int>(i) * kStep);
    constexpr double kFine = 4096;
    if (!joints_at(static_cast<double>(sample.tau.count()) - static_cast<double>(back) / kFine, q[i])) return;
  }
  const double per_h3 = 1 / std::pow(to_seconds(kStep), 3);
  for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
    const double ratio = std::abs(q[0][j] - 3 * q[1][j] + 3 * q[2][j] - q[3][j]) * per_h3 / limits_[j];
    if (rate < 1) max_ramp_ratio_ = std::max(max_ramp_ratio_, ratio);
    if (ratio > max_ratio_) {
      max_ratio_ = ratio;
      worst_joint_ = static_cast<int>(j);
      worst_time_s_ = to_seconds(sample.time);
    }
  }
}

}  // namespace kinebus
