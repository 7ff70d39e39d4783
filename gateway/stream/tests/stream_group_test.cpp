#include "gateway/stream/stream_group.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/stream/tests/m1_axes.hpp"
#include "gateway/stream/tests/model_node.hpp"
#include "gateway/stream/tests/motions.hpp"

namespace kinebus::testing {
namespace {

StreamGroup::Options with_bus_share(double share) {
  StreamGroup::Options options;
  options.budget.share = share;
  return options;
}

/// A machine of model nodes on an ideal bus; path time runs at the rate that the group allows.
class Bench {
 public:
  explicit Bench(double bus_share = 0.6)
      : kinematics(m1()), group(*kinematics, m1_axes(), with_bus_share(bus_share)) {}

  void stand_at(const Phase& first) {
    JointVector joints{};
    ASSERT_TRUE(kinematics->inverse(first.piece.frame, first.piece.evaluate(first.s0).x, joints));
    for (const NodeAxes& node : axes) {
      std::array<AxisState, kAxesPerNode> states{};
      for (std::size_t i = 0; i < states.size(); ++i)  // whole counts, as after homing
        states[i].position = to_fixed(
            std::round(node.axes[i].to_counts(joints[static_cast<std::size_t>(node.axes[i].joint)])));
      nodes.emplace_back(node.node_id, states);
      group.set_state(node.node_id, states, nodes.back().status());
    }
  }

  /// Streams all phases as a run and lets path time pass to its end.
  void run(const std::vector<Phase>& phases) {
    std::size_t k = 0;
    group.begin_run();
    bool released = false;
    for (int guard = 0; guard < 1'000'000 && !group.run_done(tau); ++guard) {
      while (k < phases.size() && group.wants_phases(tau)) {
        const auto ok = group.push(phases[k++]);
        ASSERT_TRUE(ok) << to_string(ok.error());
      }
      if (!released) {
        group.release(tau + PathTime{16'000 * 150});
        released = true;
      }
      // A millisecond of bus: seven frames at most.
      for (int n = 0; n < 7; ++n) {
        const auto frame = group.next_frame(now, tau);
        if (!frame) break;
        ++frames;
        for (ModelNode& node : nodes) node.on_frame(*frame);
      }
      const double rate = group.allowed_rate(tau);
      least_rate = std::min(least_rate, rate);
      now += std::chrono::milliseconds{1};
      tau += PathTime{static_cast<std::int64_t>(16'000 * rate)};
      for (ModelNode& node : nodes) {
        node.advance_to(tau);
        if (guard % 50 != node.id()) continue;
        const auto ok = group.on_status(now, node.id(), node.status(), tau);
        ASSERT_TRUE(ok) << to_string(ok.error());
      }
    }
    ASSERT_TRUE(group.run_done(tau));
    for (const ModelNode& node : nodes) EXPECT_EQ(node.complaint, "") << "node " << int{node.id()};
  }

  /// Largest distance of any axis from the exact inverse kinematics of the phases, counts.
  double worst_error(const std::vector<Phase>& phases) {
    double worst = 0, start_s = to_seconds(group.run_start());
    for (const Phase& phase : phases) {
      for (int i = 0; i < 8; ++i) {
        const double t = phase.duration_s * i / 8;
        JointVector joints{};
        EXPECT_TRUE(kinematics->inverse(phase.piece.frame, phase.at(t).x, joints));
        const PathTime at{static_cast<std::int64_t>(std::llround((start_s + t) * 16e6))};
        for (std::size_t n = 0; n < nodes.size(); ++n)
          for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
            const AxisScaling& scaling = axes[n].axes[axis];
            const double wanted = scaling.to_counts(joints[static_cast<std::size_t>(scaling.joint)]);
            worst = std::max(worst, std::abs(wanted - to_counts(nodes[n].position(at, axis))));
          }
      }
      start_s += phase.duration_s;
    }
    return worst;
  }

  std::unique_ptr<Kinematics> kinematics;
  StreamGroup group;
  std::vector<NodeAxes> axes = m1_axes();
  std::vector<ModelNode> nodes;
  BusTime now{0};
  PathTime tau{0};
  std::size_t frames = 0;
  double least_rate = 1;
};

double seconds_of(const std::vector<Phase>& phases) {
  double s = 0;
  for (const Phase& p : phases) s += p.duration_s;
  return s;
}

TEST(StreamGroup, NodesFollowAPrintWithinHalfACountFromDecodedFramesAlone) {
  Bench bench;
  const auto phases = printed_lines(21, {.lines = 150});
  bench.stand_at(phases.front());
  bench.run(phases);
  // Whole counts at the start leave up to half a count there, which goes within the first segments.
  EXPECT_LE(bench.worst_error(phases), 0.61);
  EXPECT_EQ(bench.least_rate, 1);
  EXPECT_LT(static_cast<double>(bench.frames) / seconds_of(phases), 140);
  for (const ModelNode& node : bench.nodes) EXPECT_TRUE(node.ended);
}

TEST(StreamGroup, ASecondRunContinuesFromTheExactStates) {
  Bench bench;
  const auto first = printed_lines(3, {.lines = 20});
  bench.stand_at(first.front());
  bench.run(first);
  // Back along the same way: the last phase's end is the first pose of the second run.
  std::vector<Phase> second(1);
  Pose end = first.back().at(first.back().duration_s).x;
  for (std::size_t k = 0; k < kPoseAxes; ++k) second[0].piece.coefficients[k] = {end[k], 0, 0, 0};
  second[0].piece.coefficients[kX][1] = end[kX] > 0 ? -1 : 1;
  second[0].piece.length = 20;
  second[0].a = 500;
  second[0].duration_s = 0.1;
  second.push_back(second[0]);
  second[1].s0 = 2.5;
  second[1].v0 = 50;
  second[1].a = -500;
  second[1].last = true;
  bench.run(second);
  EXPECT_LE(bench.worst_error(second), 0.5);
}

TEST(StreamGroup, PathTimeWaitsUntilTheNodesHaveConfirmedTheTimeToLookAndToStop) {
  Bench bench;
  const auto phases = printed_lines(21, {.lines = 150});
  bench.stand_at(phases.front());
  bench.group.begin_run();
  for (std::size_t k = 0; bench.group.wants_phases({}); ++k) ASSERT_TRUE(bench.group.push(phases[k]));
  bench.group.release(PathTime{16'000 * 150});
  const std::int64_t enough = bench.group.run_start().count() / kPathTicksPerUnit + 9'375;  // 150 ms
  int waits = 0, primed = 0;
  while (const auto frame = bench.group.next_frame({}, {})) {
    std::int64_t least = INT64_MAX;
    for (std::size_t n = 0; n < bench.nodes.size(); ++n) {
      bench.nodes[n].on_frame(*frame);
      ASSERT_TRUE(bench.group.on_status({}, bench.nodes[n].id(), bench.nodes[n].status(), {}));
      least = std::min(least, bench.group.stream(n).accepted_until_units());
    }
    EXPECT_EQ(bench.group.primed({}), least >= enough) << least;
    ++(least >= enough ? primed : waits);
  }
  EXPECT_GT(waits, 5);
  EXPECT_GT(primed, 0);
}

TEST(StreamGroup, ANarrowBusSlowsThePathAndStarvesNobody) {
  // Lines of a millimetre take 320 frames a second at full rate; 5 % less overhead carry 146.
  Bench bench(0.05);
  const auto phases = printed_lines(5, {.lines = 100, .mean_length_mm = 1});
  bench.stand_at(phases.front());
  bench.run(phases);
  EXPECT_LT(bench.least_rate, 0.7);
  EXPECT_GT(bench.least_rate, 0.2);
  const double bus_s = to_seconds(bench.now) - 0.15;
  EXPECT_LT(static_cast<double>(bench.frames) * 135 / (bus_s * 1e6), 0.035);
}

TEST(StreamGroup, JointsAtAStopAreWhereTheNodesAre) {
  Bench bench;
  const auto phases = printed_lines(8, {.lines = 60});
  bench.stand_at(phases.front());
  std::size_t k = 0;
  bench.group.begin_run();
  while (k < phases.size() && bench.group.wants_phases(bench.tau)) ASSERT_TRUE(bench.group.push(phases[k++]));
  bench.group.release(PathTime{16'000 * 100});
  while (const auto frame = bench.group.next_frame(bench.now, bench.tau))
    for (ModelNode& node : bench.nodes) node.on_frame(*frame);
  const PathTime stop{16'000 * 333 + 77};
  for (ModelNode& node : bench.nodes) {
    node.advance_to(stop);
    ASSERT_TRUE(bench.group.on_status(bench.now, node.id(), node.status(), stop));
  }
  const auto joints = bench.group.joints_at(stop);
  ASSERT_TRUE(joints);
  for (std::size_t n = 0; n < bench.nodes.size(); ++n)
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
      const AxisScaling& scaling = bench.axes[n].axes[axis];
      EXPECT_NEAR(scaling.to_counts((*joints)[static_cast<std::size_t>(scaling.joint)]),
                  to_counts(bench.nodes[n].position(stop, axis)), 1e-6);
    }
  EXPECT_GT(bench.group.line_at(stop), 0u);
}

TEST(StreamGroup, RefusesARunThatStartsWhereTheAxesAreNot) {
  Bench bench;
  const auto phases = printed_lines(8, {.lines = 5});
  bench.stand_at(phases.front());
  auto elsewhere = phases;
  elsewhere[0].piece.coefficients[kZ][0] += 0.1;
  bench.group.begin_run();
  const auto ok = bench.group.push(elsewhere[0]);
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().kind, StreamError::Kind::kStartMismatch);
}

TEST(StreamGroup, TakesPhasesOnlyAsFarAheadAsItsLead) {
  Bench bench;
  const auto phases = printed_lines(8, {.lines = 400});
  bench.stand_at(phases.front());
  bench.group.begin_run();
  std::size_t k = 0;
  while (bench.group.wants_phases(PathTime{0})) ASSERT_TRUE(bench.group.push(phases[k++]));
  EXPECT_GT(bench.group.sampler().end_s(), 1.59);
  EXPECT_LT(bench.group.sampler().end_s(), 1.9);
}

}  // namespace
}  // namespace kinebus::testing
