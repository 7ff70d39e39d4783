#pragma once
// A group of streams and model nodes that take what is sent at once, step by step.

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "gateway/stream/stream_group.hpp"
#include "gateway/stream/tests/m1_axes.hpp"
#include "gateway/stream/tests/model_node.hpp"

namespace kinebus::testing {

inline PathTime path_ms(double ms) {
  return PathTime{static_cast<std::int64_t>(16'000 * ms)};
}

/// From where `phases` end, along X and back to rest.
inline std::vector<Phase> onward(const std::vector<Phase>& phases, double seconds = 0.2) {
  std::vector<Phase> out(2);
  const Pose end = phases.back().at(phases.back().duration_s).x;
  for (std::size_t k = 0; k < kPoseAxes; ++k) out[0].piece.coefficients[k] = {end[k], 0, 0, 0};
  out[0].piece.coefficients[kX][1] = end[kX] > 0 ? -1 : 1;
  out[0].a = 500;
  out[0].duration_s = seconds / 2;
  out[0].piece.length = out[0].a * out[0].duration_s * out[0].duration_s;
  out[1] = out[0];
  out[1].s0 = out[0].piece.length / 2;
  out[1].v0 = out[0].a * out[0].duration_s;
  out[1].a = -out[0].a;
  out[1].last = true;
  return out;
}

/// Three model nodes that take what is sent at once.
class ModelMachine {
 public:
  explicit ModelMachine(std::vector<NodeAxes> of = m1_axes(), const StreamGroup::Options& options = {})
      : axes(std::move(of)), kinematics(m1()), group(*kinematics, axes, options) {}

  void stand_at(const Phase& first) {
    JointVector joints{};
    ASSERT_TRUE(kinematics->inverse(first.piece.frame, first.piece.evaluate(first.s0).x, joints));
    nodes.clear();
    for (const NodeAxes& node : axes) {
      std::array<AxisState, kAxesPerNode> states{};
      for (std::size_t i = 0; i < states.size(); ++i)
        if (node.axes[i].joint >= 0)
          states[i].position =
              to_fixed(node.axes[i].to_counts(joints[static_cast<std::size_t>(node.axes[i].joint)]));
      nodes.emplace_back(node.node_id, states);
      group.set_state(node.node_id, states, nodes.back().status());
    }
  }
  void fill(const std::vector<Phase>& phases) {
    while (next < phases.size() && group.wants_phases(tau)) {
      const auto ok = group.push(phases[next++]);
      ASSERT_TRUE(ok) << to_string(ok.error());
    }
  }
  void send(int most = 1'000'000) {
    for (; most > 0; --most) {
      const auto frame = group.next_frame(now, tau);
      if (!frame) return;
      for (ModelNode& node : nodes) node.on_frame(*frame);
    }
  }
  void tell() {
    for (ModelNode& node : nodes) {
      node.advance_to(tau);
      const auto ok = group.on_status(now, node.id(), node.status(), tau);
      ASSERT_TRUE(ok) << to_string(ok.error());
    }
  }
  /// Where the joints are to be now; nullopt: the run has not begun, or is over.
  std::optional<JointVector> planned_joints(const std::vector<Phase>& phases) const {
    const double t = to_seconds(tau) - to_seconds(group.run_start());
    double start = 0;
    std::size_t k = 0;
    while (k < phases.size() && start + phases[k].duration_s < t) start += phases[k++].duration_s;
    JointVector joints{};
    if (k == phases.size() || t < 0) return std::nullopt;
    EXPECT_TRUE(kinematics->inverse(phases[k].piece.frame, phases[k].at(t - start).x, joints));
    return joints;
  }
  void pass(double ms) {
    tau += path_ms(ms);
    now += std::chrono::milliseconds{10};
  }
  void run(const std::vector<Phase>& phases) {
    next = 0;
    group.begin_run();
    fill(phases);
    group.release(tau + path_ms(100));
    for (int guard = 0; guard < 100'000 && !group.run_done(tau); ++guard) {
      fill(phases);
      send();
      pass(10);
      tell();
    }
    ASSERT_TRUE(group.run_done(tau));
    for (const ModelNode& node : nodes) EXPECT_EQ(node.complaint, "");
  }

  std::vector<NodeAxes> axes;
  std::unique_ptr<Kinematics> kinematics;
  StreamGroup group;
  std::vector<ModelNode> nodes;
  std::size_t next = 0;
  PathTime tau{0};
  BusTime now{0};
};

}  // namespace kinebus::testing
