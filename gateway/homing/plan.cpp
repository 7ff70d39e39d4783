#include "gateway/homing/plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

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

/// What each joint does while the tool goes 1 mm straight away from the table. nullopt: not the same
/// everywhere, or other joints take part in it.
std::optional<std::vector<double>> straight(const Kinematics& kinematics, Frame frame,
                                            const std::vector<Joint>& joints) {
  std::vector<double> rates;
  const Pose centre = kinematics.bed_reference();
  constexpr double kAside_mm = 30, kTilt_rad = 0.15;
  for (const auto& [x, y, a] : {std::array{0.0, 0.0, 0.0}, std::array{kAside_mm, -kAside_mm, kTilt_rad},
                                std::array{-kAside_mm, kAside_mm, -kTilt_rad}}) {
    Pose pose = centre;
    pose[kX] += x;
    pose[kY] += y;
    pose[kA] += a;
    JointVector at{};
    std::array<double, std::size_t{kMaxJoints} * kPoseAxes> matrix{};
    if (!kinematics.jacobian(frame, pose, at, matrix)) continue;  // a machine that does not tilt, or go there
    constexpr double kSame = 1e-6;
    double others = 0;
    for (int j = 0; j < kinematics.joint_count(); ++j)
      others += std::abs(matrix[static_cast<std::size_t>(j) * kPoseAxes + kZ]);
    std::vector<double> here;
    for (const Joint& j : joints) {
      here.push_back(matrix[j.joint * kPoseAxes + kZ]);
      others -= std::abs(here.back());
    }
    if (others > kSame) return std::nullopt;
    if (rates.empty()) rates = here;
    for (std::size_t i = 0; i < here.size(); ++i)
      if (std::abs(here[i] - rates[i]) > kSame) return std::nullopt;
  }
  return rates;
}

/// The fastest rates that take the tool straight away and are not faster than the joints' own.
std::vector<double> lift_of(const Kinematics& kinematics, const std::vector<Joint>& joints) {
  for (const Frame frame : {Frame::kMachine, Frame::kPart}) {
    const auto rates = straight(kinematics, frame, joints);
    if (!rates) continue;
    double speed = HUGE_VAL, own = 0;  // of the tool, and what the joints' own speeds would make it at most
    bool possible = true;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const double rate = (*rates)[i] * joints[i].direction();
      if (std::abs(rate) < 1e-9) continue;
      possible = possible && rate > 0 && joints[i].moves;
      speed = std::min(speed, joints[i].fast_per_s / std::abs(rate));
      own = std::max(own, joints[i].fast_per_s / std::abs(rate));
    }
    constexpr double kSameSpeed = 1e-6;
    if (!possible || !std::isfinite(speed)) continue;
    if (own - speed < kSameSpeed * speed) return {};
    std::vector<double> lift;
    for (const double rate : *rates) lift.push_back(std::abs(rate) < 1e-9 ? 0 : std::abs(rate) * speed);
    return lift;
  }
  return {};
}

Stage stage_of(const Kinematics& kinematics, std::vector<Joint> joints) {
  Stage stage;
  stage.joints = std::move(joints);
  stage.parting_mm_per_s = parting(kinematics, stage.joints);
  stage.effect = effect_of(stage.parting_mm_per_s, stage.joints);
  if (stage.effect == Effect::kParts) stage.lift_per_s = lift_of(kinematics, stage.joints);
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
