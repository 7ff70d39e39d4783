#pragma once
// M1's six joints on three nodes, and joint motions sampled from phases.

#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "gateway/kinematics/geometry.hpp"
#include "gateway/motion/joint_span.hpp"
#include "gateway/motion/trajectory.hpp"
#include "gateway/stream/axis_scaling.hpp"
#include "gateway/stream/joint_sampler.hpp"

namespace kinebus::testing {

inline std::vector<NodeAxes> m1_axes() {
  std::vector<NodeAxes> nodes(3);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].node_id = static_cast<std::uint8_t>(i + 1);
    nodes[i].axes[0].joint = static_cast<int>(2 * i);
    nodes[i].axes[1].joint = static_cast<int>(2 * i + 1);
  }
  AxisScaling& table = nodes[2].axes[0];
  table.counts_per_unit = 51200 * 3 / (2 * std::numbers::pi);
  table.acceleration_limit = 3600 * kRadPerDeg;
  AxisScaling& extruder = nodes[2].axes[1];
  extruder.counts_per_unit = 51200 / 23.2;
  extruder.acceleration_limit = 3000;
  return nodes;
}

inline std::unique_ptr<Kinematics> m1() {
  return make_m1_kinematics({}).value();
}

/// All spans of a run; throws where the sampler refuses.
inline std::vector<JointSpan> sample(const Kinematics& kinematics, const std::vector<Phase>& phases) {
  JointSampler sampler(kinematics);
  std::vector<JointSpan> spans;
  for (const Phase& phase : phases) {
    if (auto ok = sampler.push(phase); !ok) throw std::runtime_error(to_string(ok.error()));
    for (;;) {
      const auto span = sampler.next();
      if (!span) throw std::runtime_error(to_string(span.error()));
      if (!*span) break;
      spans.push_back(**span);
    }
  }
  return spans;
}

/// The states in which the axes stand at the first span's start, to the nearest 2^-32 counts.
inline std::array<AxisState, kAxesPerNode> standing_at(const NodeAxes& node, const JointSpan& span) {
  std::array<AxisState, kAxesPerNode> states{};
  for (std::size_t i = 0; i < states.size(); ++i)
    if (node.axes[i].joint >= 0)
      states[i].position = to_fixed(node.axes[i].to_counts(span.position(node.axes[i].joint, 0)));
  return states;
}

}  // namespace kinebus::testing
