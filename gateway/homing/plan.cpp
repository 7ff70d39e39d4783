#include "gateway/homing/plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace kinebus::homing {
namespace {

/// Numbers the groups of joints that act on the same pose axis, directly or by way of others.
std::vector<std::size_t> groups_of(const Kinematics& kinematics, std::span<const Joint> joints) {
  std::vector<std::size_t> group(joints.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  Pose near = kinematics.bed_reference();
  // A pose that is special in nothing.
  near[kX] += 7;
  near[kY] += 5;
  near[kZ] += 3;
  for (const Pose& pose : {kinematics.bed_reference(), near}) {
    JointVector at{};
    std::array<double, std::size_t{kMaxJoints} * kPoseAxes> matrix{};
    if (!kinematics.jacobian(Frame::kMachine, pose, at, matrix)) continue;
    constexpr double kActs = 1e-6;
    for (std::size_t axis = 0; axis < kPoseAxes; ++axis)
      for (std::size_t i = 0; i < joints.size(); ++i)
        for (std::size_t j = i + 1; j < joints.size(); ++j)
          if (std::abs(matrix[joints[i].joint * kPoseAxes + axis]) > kActs &&
              std::abs(matrix[joints[j].joint * kPoseAxes + axis]) > kActs)
            std::replace(group.begin(), group.end(), std::max(group[i], group[j]),
                         std::min(group[i], group[j]));
  }
  return group;
}

/// How fast the tool leaves the table while these joints go to their switches, the others at rest.
double parting(const Kinematics& kinematics, std::span<const Joint> joints) {
  const Pose from = kinematics.bed_reference();
  JointVector q{};
  if (!kinematics.inverse(Frame::kMachine, from, q)) return 0;
  double fastest = 0;
  for (const Joint& j : joints)
    if (j.moves) fastest = std::max(fastest, j.fast_per_s);
  if (!(fastest > 0)) return 0;
  constexpr double kWay = 0.01;  // mm or rad
  const double seconds = kWay / fastest;
  for (const Joint& j : joints)
    if (j.moves) q[j.joint] += j.direction() * j.fast_per_s * seconds;
  Pose to = from;
  if (!kinematics.forward(Frame::kMachine, q, to)) return 0;
  return (to[kZ] - from[kZ]) / seconds;
}

Effect effect_of(double parting_mm_per_s, const std::vector<Joint>& joints) {
  double fastest = 0;
  for (const Joint& j : joints) fastest = std::max(fastest, j.fast_per_s);
  // A mechanism that moves a little askew does not count as leaving the table.
  const double little = 0.05 * fastest;
  if (parting_mm_per_s > little) return Effect::kParts;
  return parting_mm_per_s < -little ? Effect::kNears : Effect::kKeeps;
}

Stage stage_of(const Kinematics& kinematics, std::vector<Joint> joints) {
  Stage stage{.joints = std::move(joints)};
  stage.parting_mm_per_s = parting(kinematics, stage.joints);
  stage.effect = effect_of(stage.parting_mm_per_s, stage.joints);
  return stage;
}

}  // namespace

Plan make_plan(const Kinematics& kinematics, std::span<const Joint> joints) {
  Plan plan;
  plan.stated = !joints.empty() &&
                std::all_of(joints.begin(), joints.end(), [](const Joint& j) { return j.order != 0; });
  std::array<std::vector<Joint>, 256> sorted;
  if (plan.stated) {
    for (const Joint& j : joints) sorted[j.order].push_back(j);
  } else {
    const std::vector<std::size_t> group = groups_of(kinematics, joints);
    for (std::size_t g = 0; g < joints.size(); ++g) {
      std::vector<Joint> members;
      for (std::size_t i = 0; i < joints.size(); ++i)
        if (group[i] == g) members.push_back(joints[i]);
      if (members.empty()) continue;
      const auto effect = static_cast<std::size_t>(stage_of(kinematics, members).effect);
      sorted[effect].insert(sorted[effect].end(), members.begin(), members.end());
    }
  }
  for (std::vector<Joint>& members : sorted)
    if (!members.empty()) plan.stages.push_back(stage_of(kinematics, std::move(members)));
  return plan;
}

}  // namespace kinebus::homing
