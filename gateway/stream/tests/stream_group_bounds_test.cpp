// A group of streams at its bounds: before a run is released, with queues that are full, between two runs,
// and with axes that are unlike each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/stream/tests/model_machine.hpp"
#include "gateway/stream/tests/motions.hpp"

namespace kinebus::testing {
namespace {

/// Stands still at the first pose of `phases`.
Phase still(const std::vector<Phase>& phases, double seconds) {
  Phase phase = phases.front();
  phase.v0 = phase.a = 0;
  phase.duration_s = seconds;
  phase.last = true;
  return phase;
}

double longest(const std::vector<Phase>& phases) {
  double most = 0;
  for (const Phase& phase : phases) most = std::max(most, phase.duration_s);
  return most;
}

TEST(StreamGroup, KeepsItsLeadHoweverLateTheRunIs) {
  ModelMachine m;
  const auto phases = printed_lines(8, {.lines = 400});
  m.stand_at(phases.front());
  m.tau = path_ms(100'000);
  m.group.begin_run();
  m.fill(phases);
  EXPECT_GE(m.group.sampler().end_s(), 1.6) << "counts from the run's start";
  EXPECT_LT(m.group.sampler().end_s(), 1.6 + longest(phases));
  EXPECT_EQ(m.group.allowed_rate(m.tau), 1) << "nothing is late before the release";
  const double before = m.group.sampler().end_s();
  m.group.release(m.tau + path_ms(500));
  m.fill(phases);
  EXPECT_EQ(m.group.sampler().end_s(), before) << "the start is still to come";
  for (int k = 0; k < 300; ++k) {
    m.send();
    m.pass(10);
    m.tell();
    m.fill(phases);
    const double ahead =
        m.group.sampler().end_s() - std::max(0.0, to_seconds(m.tau) - to_seconds(m.group.run_start()));
    EXPECT_GE(ahead, 1.6);
    EXPECT_LT(ahead, 1.6 + longest(phases));
  }
}

TEST(StreamGroup, ARunThatIsNotReleasedIsNeitherPrimedNorDone) {
  ModelMachine m;
  const auto phases = printed_lines(3, {.lines = 60});
  m.stand_at(phases.front());
  m.group.begin_run();
  const std::vector<Phase> one{still(phases, 0.02)};
  m.fill(one);
  ASSERT_TRUE(m.group.complete());
  for (ModelNode& node : m.nodes) {
    StreamStatus full = node.status();
    full.free_records = 0;
    ASSERT_TRUE(m.group.on_status(m.now, node.id(), full, path_ms(1000)));
  }
  EXPECT_FALSE(m.group.primed(m.tau));
  EXPECT_FALSE(m.group.run_done(path_ms(1000)));
  EXPECT_FALSE(m.group.may_begin());
  EXPECT_EQ(m.group.state(), StreamGroup::State::kFilling);
}

TEST(StreamGroup, ARunThatHasNothingMoreForNowIsNeitherPrimedNorDone) {
  ModelMachine m;
  const auto phases = printed_lines(3, {.lines = 60});
  m.stand_at(phases.front());
  m.group.begin_run();
  // What is pushed is fitted as far as the look-ahead has seen it.
  m.next = 0;
  while (m.group.sampler().end_s() < 0.45) ASSERT_TRUE(m.group.push(phases[m.next++]));
  m.group.release(path_ms(100));
  m.send();
  m.tell();
  ASSERT_FALSE(m.group.complete());
  EXPECT_FALSE(m.group.primed(m.tau)) << "all that is made is accepted, and is not enough";
  const PathTime late = m.group.fitted_until() + path_ms(1);
  EXPECT_LT(late, path_ms(100 + 150));
  EXPECT_FALSE(m.group.run_done(late));
  EXPECT_FALSE(m.group.may_begin());
}

TEST(StreamGroup, ARunIsDoneWhenEveryNodeHasAcceptedItsEndAndNotBefore) {
  ModelMachine m;
  const auto phases = printed_lines(3, {.lines = 60});
  m.stand_at(phases.front());
  m.group.begin_run();
  const std::vector<Phase> one{still(phases, 0.02)};
  m.fill(one);
  m.group.release(path_ms(100));
  m.send();
  m.pass(1000);
  EXPECT_FALSE(m.group.run_done(m.tau)) << "nobody has said so";
  for (ModelNode& node : m.nodes) {
    node.advance_to(m.tau);
    EXPECT_FALSE(m.group.run_done(m.tau));
    ASSERT_TRUE(m.group.on_status(m.now, node.id(), node.status(), m.tau));
  }
  EXPECT_TRUE(m.group.run_done(m.tau));
  EXPECT_EQ(m.group.state(), StreamGroup::State::kDone);
  m.group.cancel();
  EXPECT_FALSE(m.group.run_done(m.tau)) << "what was cancelled is over, and not done";
}

TEST(StreamGroup, ASecondRunIsMadeFromItsOwnStart) {
  ModelMachine m;
  const auto phases = printed_lines(3, {.lines = 10});
  m.stand_at(phases.front());
  m.run(phases);
  m.group.begin_run();
  EXPECT_EQ(m.group.run_start(), PathTime{0});
  EXPECT_EQ(m.group.fitted_until(), PathTime{0});
  const auto elsewhere = m.group.push(phases.front());
  ASSERT_FALSE(elsewhere) << "it must go on where the first one ended";
  EXPECT_EQ(elsewhere.error().kind, StreamError::Kind::kStartMismatch);
  EXPECT_EQ(elsewhere.error().line, phases.front().line);
}

TEST(StreamGroup, AQueueThatIsFullBeforeTheEndIsSentToTheEnd) {
  StreamGroup::Options ahead;
  ahead.lead_s = 1000;
  int full = 0, at_the_end = 0;
  for (int lines = 380; lines < 420; ++lines) {
    ModelMachine m(m1_axes(), ahead);
    const auto phases = printed_lines(5, {.lines = lines, .mean_length_mm = 0.4});
    m.stand_at(phases.front());
    m.group.begin_run();
    m.fill(phases);
    bool no_room = false;
    for (std::size_t n = 0; n < 3; ++n) {
      EXPECT_LT(m.group.stream(n).room(), NodeStream::kCapacity) << "a room below nothing";
      no_room |= m.group.stream(n).room() == 0;
    }
    full += no_room;
    at_the_end += no_room && m.next == phases.size();
    EXPECT_TRUE(!m.group.complete() || !no_room || m.next == phases.size());
    m.group.release(path_ms(100));
    for (int guard = 0; guard < 100'000 && !m.group.run_done(m.tau); ++guard) {
      m.fill(phases);
      m.send();
      m.pass(10);
      m.tell();
      for (std::size_t n = 0; n < 3; ++n) EXPECT_LT(m.group.stream(n).room(), NodeStream::kCapacity) << lines;
    }
    ASSERT_TRUE(m.group.run_done(m.tau)) << lines;
    for (const ModelNode& node : m.nodes) {
      EXPECT_EQ(node.complaint, "") << lines;
      EXPECT_TRUE(node.ended);
    }
  }
  EXPECT_GT(full, 5);
  EXPECT_GT(at_the_end, 0);
}

/// Along X from where `phases` end, to beyond the machine's reach.
Phase away_from(const std::vector<Phase>& phases) {
  Phase away = onward(phases).front();
  away.line = 777;
  away.duration_s = 2;
  away.piece.length = 2000;
  away.a = 1000;
  return away;
}

TEST(StreamGroup, AStatusThatMakesRoomMayFindThatThePathLeavesTheReach) {
  StreamGroup::Options ahead;
  ahead.lead_s = 1000;
  int by_status = 0;
  for (int lines = 380; lines < 420; ++lines) {
    ModelMachine m(m1_axes(), ahead);
    auto phases = printed_lines(5, {.lines = lines, .mean_length_mm = 0.4});
    phases.back().last = false;
    m.stand_at(phases.front());
    m.group.begin_run();
    while (m.next < phases.size() && m.group.wants_phases(m.tau))
      ASSERT_TRUE(m.group.push(phases[m.next++])) << lines;
    if (m.next < phases.size() || !m.group.wants_phases(m.tau)) continue;
    const auto pushed = m.group.push(away_from(phases));
    if (!pushed) continue;  // there was room for all that can be reached
    m.group.release(path_ms(100));
    bool refused = false;
    for (int guard = 0; guard < 1000 && !refused; ++guard) {
      m.send();
      m.pass(10);
      for (ModelNode& node : m.nodes) {
        node.advance_to(m.tau);
        const auto ok = m.group.on_status(m.now, node.id(), node.status(), m.tau);
        if (ok) continue;
        refused = true;
        EXPECT_EQ(ok.error().kind, StreamError::Kind::kPose);
        EXPECT_EQ(ok.error().line, 777u);
        break;
      }
    }
    EXPECT_TRUE(refused) << lines;
    ++by_status;
  }
  EXPECT_GT(by_status, 0);
}

TEST(StreamGroup, WhatIsCancelledMakesNoRecordsAnyMore) {
  StreamGroup::Options ahead;
  ahead.lead_s = 1000;
  for (const bool full : {false, true}) {
    ModelMachine m(m1_axes(), full ? ahead : StreamGroup::Options{});
    const auto phases = printed_lines(3, {.lines = 600, .mean_length_mm = 0.4});
    m.stand_at(phases.front());
    m.group.begin_run();
    m.fill(phases);
    EXPECT_EQ(m.group.stream(0).room() == 0 || m.group.stream(1).room() == 0, full);
    m.group.release(path_ms(100));
    m.send(40);
    m.group.cancel();
    EXPECT_TRUE(m.group.sampler().wants_phase()) << "what was under way is dropped";
    for (ModelNode& node : m.nodes) {
      node = ModelNode(node.id(), node.tail());
      m.group.set_state(node.id(), node.tail(), node.status());
    }
    m.tell();
    for (std::size_t n = 0; n < 3; ++n) {
      EXPECT_EQ(m.group.stream(n).unsent(), 0u);
      EXPECT_EQ(m.group.stream(n).final_state()[0].position, m.nodes[n].tail()[0].position);
    }
  }
}

/// A queue that was full when the run was lost is empty now.
TEST(StreamGroup, WhatANodeHadRoomForBeforeALostRunPrimesNoOther) {
  ModelMachine m;
  const auto phases = printed_lines(3, {.lines = 60});
  m.stand_at(phases.front());
  for (ModelNode& node : m.nodes) {
    node.capacity = 3;
    m.group.set_state(node.id(), node.tail(), node.status());
  }
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(100));
  m.send();
  m.tell();
  ASSERT_TRUE(m.group.primed(m.tau)) << "full";
  m.group.cancel();
  m.next = 0;
  m.stand_at(phases.front());
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(100));
  EXPECT_FALSE(m.group.primed(m.tau)) << "nothing was sent yet";
}

TEST(StreamGroup, WhatNobodyRemembersHasNoJoints) {
  ModelMachine m;
  const auto phases = printed_lines(3, {.lines = 60});
  m.stand_at(phases.front());
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(100));
  for (int k = 0; k < 80; ++k) {
    m.fill(phases);
    m.send();
    m.pass(10);
    m.tell();
    std::int64_t least = INT64_MAX;
    for (std::size_t n = 0; n < 3; ++n) least = std::min(least, m.group.segmenter(n).knot_units());
    EXPECT_EQ(m.group.fitted_until(), m.group.run_start() + PathTime{least * kPathTicksPerUnit});
  }
  EXPECT_TRUE(m.group.joints_at(m.tau));
  EXPECT_FALSE(m.group.joints_at(path_ms(300)));
  EXPECT_FALSE(m.group.state_at(2, path_ms(300)));
  EXPECT_FALSE(m.group.state_at(77, m.tau));
}

TEST(StreamGroup, AnotherShiftOfAccelerationsIsEverybodysShift) {
  StreamGroup::Options options;
  options.segmenter.acceleration_shift = kDefaultAccelerationShift + 2;
  ModelMachine m(m1_axes(), options);
  const auto phases = printed_lines(3, {.lines = 10});
  m.stand_at(phases.front());
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(0));
  double start = 0;
  int looked = 0;
  for (const Phase& phase : phases) {
    const PathTime tau{static_cast<std::int64_t>(start * 16e6)};
    start += phase.duration_s;
    if (tau > m.group.fitted_until() || tau == PathTime{0}) continue;
    JointVector exact{};
    ASSERT_TRUE(m.kinematics->inverse(phase.piece.frame, phase.at(0).x, exact));
    const auto joints = m.group.joints_at(tau);
    ASSERT_TRUE(joints);
    for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR((*joints)[j], exact[j], 5e-4) << j;
    ++looked;
  }
  EXPECT_GT(looked, 10);
}

TEST(StreamGroup, TheFirstJointHasItsMapToo) {
  auto axes = m1_axes();
  JointCalibration calibration;
  calibration.pitch = 5;
  calibration.periodic_sine = 0.05;
  axes[0].axes[0].map = std::make_shared<const JointMap>(calibration);
  ModelMachine m(axes);
  const auto phases = printed_lines(3, {.lines = 10});
  m.stand_at(phases.front());
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(0));
  JointVector exact{};
  ASSERT_TRUE(m.kinematics->inverse(phases[6].piece.frame, phases[6].at(0).x, exact));
  double start = 0;
  for (int k = 0; k < 6; ++k) start += phases[static_cast<std::size_t>(k)].duration_s;
  const PathTime tau{static_cast<std::int64_t>(start * 16e6)};
  EXPECT_NEAR(to_counts((*m.group.state_at(1, tau))[0].position), axes[0].axes[0].to_counts(exact[0]), 0.6);
  EXPECT_NEAR((*m.group.joints_at(tau))[0], exact[0], 5e-4);
}

}  // namespace
}  // namespace kinebus::testing
