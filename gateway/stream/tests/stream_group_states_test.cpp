// A group of streams between its runs: what may begin, what is primed, what was lost, where the axes are.
#include <gtest/gtest.h>

#include <cmath>

#include "gateway/stream/tests/model_machine.hpp"
#include "gateway/stream/tests/motions.hpp"

namespace kinebus::testing {
namespace {

TEST(StreamGroup, GoesThroughItsStatesAndTakesPhasesInTwoOfThem) {
  ModelMachine m;
  const auto phases = printed_lines(3, {.lines = 20});
  using State = StreamGroup::State;
  EXPECT_EQ(m.group.state(), State::kIdle);
  EXPECT_TRUE(m.group.may_begin());
  EXPECT_FALSE(m.group.wants_phases(m.tau));
  EXPECT_FALSE(m.group.next_frame(m.now, m.tau));
  EXPECT_EQ(m.group.allowed_rate(m.tau), 1);
  EXPECT_FALSE(m.group.primed(m.tau));
  EXPECT_FALSE(m.group.run_done(m.tau));
  m.stand_at(phases.front());
  m.group.begin_run();
  EXPECT_EQ(m.group.state(), State::kFilling);
  EXPECT_FALSE(m.group.may_begin());
  EXPECT_TRUE(m.group.wants_phases(m.tau));
  m.fill(phases);
  EXPECT_FALSE(m.group.next_frame(m.now, m.tau)) << "not released";
  EXPECT_FALSE(m.group.primed(m.tau));
  EXPECT_EQ(m.group.allowed_rate(m.tau), 1);
  m.group.release(path_ms(100) + PathTime{1});
  EXPECT_EQ(m.group.run_start(), path_ms(100) + PathTime{256}) << "rounded up to 16 us";
  EXPECT_EQ(m.group.state(), State::kRunning);
  EXPECT_FALSE(m.group.may_begin());
  bool may_begin_before_the_end = false;
  for (int guard = 0; guard < 100'000 && m.group.state() != State::kDone; ++guard) {
    m.fill(phases);
    m.send();
    m.pass(10);
    m.tell();
    may_begin_before_the_end |= m.group.may_begin() && !m.group.run_done(m.tau);
    EXPECT_EQ(m.group.run_done(m.tau), m.group.state() == State::kDone);
  }
  EXPECT_TRUE(may_begin_before_the_end) << "the END is with all nodes before they are there";
  EXPECT_TRUE(m.group.may_begin());
  EXPECT_TRUE(m.group.complete());
  EXPECT_GE(m.tau, m.group.fitted_until());
  EXPECT_EQ(m.group.allowed_rate(m.tau), 1);
  EXPECT_FALSE(m.group.wants_phases(m.tau));
  m.run({[&] {
    Phase still = phases.front();
    const Pose end = phases.back().at(phases.back().duration_s).x;
    for (std::size_t k = 0; k < kPoseAxes; ++k) still.piece.coefficients[k] = {end[k], 0, 0, 0};
    still.v0 = still.a = still.s0 = 0;
    still.duration_s = 0.5;
    still.last = true;
    return still;
  }()});
  EXPECT_GT(m.group.run_start(), path_ms(200));
}

TEST(StreamGroup, IsPrimedWhenEachNodeHoldsTheReserveOrIsFullOrHasAll) {
  const auto phases = printed_lines(3, {.lines = 60});
  ModelMachine m;
  m.stand_at(phases.front());
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(100));
  EXPECT_FALSE(m.group.primed(m.tau));
  int frames = 0;
  const auto all_hold = [&](std::int64_t units) {
    return std::all_of(m.nodes.begin(), m.nodes.end(),
                       [&](const ModelNode& n) { return n.until_units() >= units; });
  };
  // The run begins at 6,250; 150 ms, 9,375 units, are to be confirmed.
  for (; !all_hold(6'250 + 9'375); ++frames) {
    EXPECT_FALSE(m.group.primed(m.tau)) << frames;
    m.send(1);
    m.tell();
    ASSERT_LT(frames, 1000);
  }
  EXPECT_TRUE(m.group.primed(m.tau));
  EXPECT_FALSE(m.group.primed(path_ms(100 + 150))) << "as much ahead of now, too";

  // A short queue is full before.
  ModelMachine full;
  full.stand_at(phases.front());
  for (ModelNode& node : full.nodes) {
    node.capacity = 3;
    full.group.set_state(node.id(), node.tail(), node.status());
  }
  full.group.begin_run();
  full.fill(phases);
  full.group.release(path_ms(100));
  full.send();
  EXPECT_FALSE(full.group.primed(full.tau)) << "nobody has said so";
  full.tell();
  EXPECT_TRUE(full.group.primed(full.tau));

  // A short run is with them as a whole.
  ModelMachine brief;
  std::vector<Phase> one(1, phases.front());
  one[0].v0 = one[0].a = 0;
  one[0].duration_s = 0.02;
  one[0].last = true;
  brief.stand_at(one[0]);
  brief.group.begin_run();
  brief.fill(one);
  EXPECT_TRUE(brief.group.complete());
  brief.group.release(path_ms(100));
  brief.send(4);
  brief.tell();
  EXPECT_FALSE(brief.group.primed(brief.tau));
  brief.send();
  brief.tell();
  EXPECT_TRUE(brief.group.primed(brief.tau));
  EXPECT_FALSE(brief.group.run_done(brief.tau)) << "not passed yet";
  EXPECT_EQ(brief.group.allowed_rate(brief.tau), 1);
}

TEST(StreamGroup, ServesFirstWhoHasTheLeast) {
  const auto phases = printed_lines(3, {.lines = 60});
  ModelMachine m;
  m.stand_at(phases.front());
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(10));
  for (int k = 0; k < 200; ++k) {
    std::int64_t least = INT64_MAX;
    std::array<std::int64_t, 3> before{};
    for (std::size_t n = 0; n < 3; ++n) {
      before[n] = m.group.stream(n).sent_until_units();
      if (m.group.stream(n).has_frame(m.tau)) least = std::min(least, before[n]);
    }
    const auto frame = m.group.next_frame(m.now, m.tau);
    if (!frame) break;
    EXPECT_EQ(before[(frame->id & 0x7F) - 1], least) << k;
  }
}

TEST(StreamGroup, ANodeThatIsNotItsOwnSaysNothing) {
  ModelMachine m;
  StreamStatus status;
  status.flags = StreamStatus::kUnderrun;
  EXPECT_TRUE(m.group.on_status(m.now, 77, status, m.tau));
  m.group.set_state(77, {}, status);
  EXPECT_FALSE(m.group.state_at(77, m.tau));
  EXPECT_TRUE(m.group.state_at(1, m.tau));
}

TEST(StreamGroup, PassesOnWhatANodeFoundAndWhatThePathCannotDo) {
  const auto phases = printed_lines(3, {.lines = 60});
  ModelMachine m;
  m.stand_at(phases.front());
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(100));
  m.send();
  StreamStatus status = m.nodes[1].status();
  status.flags = StreamStatus::kUnderrun;
  const auto under = m.group.on_status(m.now, 2, status, m.tau);
  ASSERT_FALSE(under);
  EXPECT_EQ(under.error().kind, StreamError::Kind::kUnderrun);
  EXPECT_EQ(under.error().node_id, 2);

  ModelMachine far;
  Phase away;
  away.line = 12;
  away.piece.coefficients[kX] = {0, 1, 0, 0};
  away.piece.coefficients[kZ] = {10, 0, 0, 0};
  away.piece.length = 2000;
  away.a = 1000;
  away.duration_s = 1.9;
  far.stand_at(away);
  far.group.begin_run();
  const auto out = far.group.push(away);
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().kind, StreamError::Kind::kPose);
  EXPECT_EQ(out.error().line, 12u);
  EXPECT_EQ(far.group.push(away).error().kind, StreamError::Kind::kPhaseOrder);
}

TEST(StreamGroup, ConfirmedIsWhatTheSlowestNodeHasPassed) {
  const auto phases = printed_lines(3, {.lines = 60});
  ModelMachine m;
  EXPECT_EQ(m.group.confirmed(path_ms(5)), path_ms(5)) << "nobody has said anything";
  m.stand_at(phases.front());
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(16));
  m.send();
  m.tau = path_ms(320);
  m.tell();
  EXPECT_EQ(m.group.confirmed(path_ms(320)), path_ms(320));
  StreamStatus slow = m.nodes[2].status();
  slow.path_units -= 500;
  ASSERT_TRUE(m.group.on_status(m.now, 3, slow, m.tau));
  EXPECT_EQ(m.group.confirmed(path_ms(320)), path_ms(320 - 8));
  EXPECT_EQ(m.group.confirmed(path_ms(100)), path_ms(100)) << "at most what is asked for";
}

TEST(StreamGroup, AfterALostRunANewOneBeginsFromWhereTheAxesAre) {
  const auto phases = printed_lines(3, {.lines = 60});
  ModelMachine m;
  m.stand_at(phases.front());
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(100));
  m.send();
  m.tau = path_ms(333);
  m.tell();
  const auto joints = m.group.joints_at(m.tau);
  ASSERT_TRUE(joints);
  std::array<std::array<AxisState, kAxesPerNode>, 3> states{};
  for (std::size_t n = 0; n < 3; ++n) states[n] = *m.group.state_at(static_cast<std::uint8_t>(n + 1), m.tau);
  m.group.cancel();
  EXPECT_EQ(m.group.state(), StreamGroup::State::kIdle);
  EXPECT_FALSE(m.group.next_frame(m.now, m.tau));
  EXPECT_FALSE(m.group.wants_phases(m.tau));
  EXPECT_TRUE(m.group.may_begin());
  EXPECT_TRUE(m.group.sampler().wants_phase()) << "what was under way is dropped";
  for (std::size_t n = 0; n < 3; ++n)
    m.group.set_state(static_cast<std::uint8_t>(n + 1), states[n], {.free_records = 120});
  EXPECT_NEAR((*m.group.joints_at(m.tau))[0], (*joints)[0], 1e-9);
  // It may not begin elsewhere.
  m.group.begin_run();
  const auto elsewhere = m.group.push(phases.front());
  ASSERT_FALSE(elsewhere);
  EXPECT_EQ(elsewhere.error().kind, StreamError::Kind::kStartMismatch);
  EXPECT_GT(elsewhere.error().amount, 4);
}

TEST(StreamGroup, TheGapsOfItsAxesAreTakenUp) {
  auto axes = m1_axes();
  for (NodeAxes& node : axes)
    for (AxisScaling& axis : node.axes) {
      axis.gap = 40 / axis.slope();
      axis.take_up_per_s2 = 400 / axis.slope() * 10;
    }
  axes[1].axes[1].joint = -1;
  ModelMachine m(axes);
  const auto phases = printed_lines(5, {.lines = 40});
  m.stand_at(phases.front());
  for (int j = 0; j < 6; ++j) EXPECT_EQ(m.group.side(j), 1) << j;
  m.next = 0;
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(100));
  for (int guard = 0; guard < 100'000 && !m.group.run_done(m.tau); ++guard) {
    m.fill(phases);
    m.send();
    m.pass(10);
    m.tell();
    // Joints are where the path is, whatever side their motors are on.
    const auto exact = m.planned_joints(phases);
    if (!exact) continue;
    const auto joints = m.group.joints_at(m.tau);
    ASSERT_TRUE(joints);
    for (std::size_t j = 0; j < 5; ++j) {
      if (j == 3) continue;
      EXPECT_NEAR((*joints)[j], (*exact)[j], j == 4 ? 3e-5 : 5e-4) << j;
    }
    EXPECT_EQ((*joints)[3], 0) << "no axis moves it";
    EXPECT_GT(m.group.line_at(m.tau), 0u);
  }
  EXPECT_TRUE(m.group.run_done(m.tau));
  int other_side = 0;
  for (int j = 0; j < 5; ++j) other_side += m.group.side(j) < -0.99;
  EXPECT_GT(other_side, 0);
  m.group.homed();
  for (int j = 0; j < 5; ++j) EXPECT_EQ(m.group.side(j), 1);
}

TEST(StreamGroup, ALostRunLeavesAMotorInsideItsGap) {
  auto axes = m1_axes();
  axes[0].axes[0].gap = 1;
  axes[0].axes[0].take_up_per_s2 = 4;  // 1 s
  ModelMachine m(axes);
  const auto phases = printed_lines(5, {.lines = 60});
  m.stand_at(phases.front());
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(100));
  double inside = 1;
  for (int guard = 0; guard < 1000 && (inside > 0.9 || inside < -0.9); ++guard) {
    m.fill(phases);
    m.send();
    m.pass(10);
    m.tell();
    JointVector joints = *m.group.joints_at(m.tau);
    // What the motor leads by, in halves of the gap.
    const double counts = to_counts((*m.group.state_at(1, m.tau))[0].position);
    inside = 2 * (counts / axes[0].axes[0].slope() - joints[0]);
  }
  ASSERT_LT(std::abs(inside), 0.9);
  (void)m.group.next_frame(m.now, m.tau);
  m.group.cancel();
  EXPECT_NEAR(m.group.side(0), inside, 0.02);
}

TEST(StreamGroup, WithoutNodesThereIsNothingToDo) {
  const auto kinematics = m1();
  StreamGroup group(*kinematics, {});
  EXPECT_EQ(group.fitted_until(), PathTime{0});
  EXPECT_EQ(group.line_at(PathTime{0}), 0u);
  EXPECT_EQ(group.allowed_rate(PathTime{0}), 1);
}

}  // namespace
}  // namespace kinebus::testing
