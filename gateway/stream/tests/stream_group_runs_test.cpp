// When a run of a group is complete, done, and may be followed by another; and axes with a map.
#include <gtest/gtest.h>

#include <algorithm>

#include "gateway/stream/stream_group.hpp"
#include "gateway/stream/tests/m1_axes.hpp"
#include "gateway/stream/tests/model_node.hpp"
#include "gateway/stream/tests/motions.hpp"

namespace kinebus::testing {
namespace {

/// Stands at the first pose; states and statuses of three model nodes.
std::vector<ModelNode> standing(StreamGroup& group, const Kinematics& kinematics,
                                const std::vector<NodeAxes>& axes, const Phase& first) {
  JointVector joints{};
  EXPECT_TRUE(kinematics.inverse(first.piece.frame, first.piece.evaluate(first.s0).x, joints));
  std::vector<ModelNode> nodes;
  for (const NodeAxes& node : axes) {
    std::array<AxisState, kAxesPerNode> states{};
    for (std::size_t i = 0; i < states.size(); ++i)
      states[i].position =
          to_fixed(node.axes[i].to_counts(joints[static_cast<std::size_t>(node.axes[i].joint)]));
    nodes.emplace_back(node.node_id, states);
    group.set_state(node.node_id, states, nodes.back().status());
  }
  return nodes;
}

TEST(StreamGroup, ARunIsCompleteWhenAllIsMadeAndFollowedWhenAllIsAccepted) {
  const auto kinematics = m1();
  const auto axes = m1_axes();
  StreamGroup group(*kinematics, axes);
  const auto phases = printed_lines(3, {.lines = 60});
  auto nodes = standing(group, *kinematics, axes, phases.front());
  group.begin_run();
  std::size_t k = 0;
  PathTime tau{0};
  BusTime now{0};
  std::array<bool, 3> told_end{};
  bool made = false;
  PathTime fitted{0};
  group.release(PathTime{16'000 * 100});
  for (int guard = 0; guard < 100'000 && !group.run_done(tau); ++guard) {
    while (k < phases.size() && group.wants_phases(tau)) ASSERT_TRUE(group.push(phases[k++]));
    // What the last phase brings is made as records leave room for it.
    made = std::all_of(nodes.begin(), nodes.end(), [&](const ModelNode& node) {
      return group.segmenter(static_cast<std::size_t>(node.id() - 1)).ended();
    });
    EXPECT_EQ(group.complete(), made) << guard;
    EXPECT_EQ(group.may_begin(),
              made && std::all_of(told_end.begin(), told_end.end(), [](bool t) { return t; }))
        << guard;
    EXPECT_GE(group.fitted_until(), fitted);
    fitted = group.fitted_until();
    for (int n = 0; n < 8; ++n)
      if (const auto frame = group.next_frame(now, tau))
        for (ModelNode& node : nodes) node.on_frame(*frame);
    now += std::chrono::milliseconds{5};
    tau += PathTime{16'000 * 5};
    // One node a turn tells what it has; its END counts once it was told of.
    ModelNode& tells = nodes[static_cast<std::size_t>(guard) % 3];
    for (ModelNode& node : nodes) node.advance_to(tau);
    ASSERT_TRUE(group.on_status(now, tells.id(), tells.status(), tau));
    if (tells.ended) told_end[tells.id() - 1u] = true;
  }
  ASSERT_TRUE(made);
  EXPECT_TRUE(group.run_done(tau));
  // The node that settled last counts.
  std::int64_t last = 0;
  for (const ModelNode& node : nodes) last = std::max(last, node.until_units());
  EXPECT_EQ(group.fitted_until(), PathTime{last * kPathTicksPerUnit});
}

TEST(StreamGroup, AnAxisWithAMapIsStreamedInItsMotorsCoordinates) {
  const auto kinematics = m1();
  auto axes = m1_axes();
  JointCalibration calibration;
  calibration.pitch = 5;
  calibration.periodic_sine = 0.05;
  axes[0].axes[1].map = std::make_shared<const JointMap>(calibration);
  StreamGroup group(*kinematics, axes);
  const auto phases = printed_lines(3, {.lines = 10});
  auto nodes = standing(group, *kinematics, axes, phases.front());
  group.begin_run();
  std::size_t k = 0;
  while (k < phases.size() && group.wants_phases(PathTime{0})) ASSERT_TRUE(group.push(phases[k++]));
  group.release(PathTime{0});
  double start = 0;
  for (const Phase& phase : phases) {
    if (start > 0.8) break;
    JointVector exact{};
    ASSERT_TRUE(kinematics->inverse(phase.piece.frame, phase.at(0).x, exact));
    const PathTime tau{static_cast<std::int64_t>(start * 16e6)};
    const double counts = to_counts((*group.state_at(1, tau))[1].position);
    EXPECT_NEAR(counts, axes[0].axes[1].to_counts(exact[1]), 0.6) << start;
    EXPECT_NEAR((*group.joints_at(tau))[1], exact[1], 5e-4);
    start += phase.duration_s;
  }
  EXPECT_GT(start, 0.5);
}

}  // namespace
}  // namespace kinebus::testing
