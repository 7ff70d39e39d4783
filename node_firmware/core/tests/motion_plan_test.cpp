#include "node_firmware/core/motion_plan.hpp"

#include <gtest/gtest.h>

#include "node_firmware/core/tests/node_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr double kMostDifference = 0.1;  // counts: 0.08 um on a carriage

std::uint64_t segment(std::uint8_t sequence, std::uint16_t units, std::int32_t a, std::int32_t b) {
  return encode(Segment{.sequence = sequence, .duration = units, .acceleration = {a, b}});
}

TEST(StreamPreview, GivesTheBitsThatTheStreamWillGive) {
  std::mt19937 random(7);
  for (int round = 0; round < 50; ++round) {
    SegmentStream stream;
    stream.set_following(0, true);
    stream.set_following(1, true);
    std::uint8_t sequence = 0;
    const auto next = [&] { return static_cast<std::uint8_t>(sequence++ % kSequenceModulus); };
    const auto start =
        encode(Segment{.sequence = next(), .control = SegmentControl::kStart, .start_units = 10});
    ASSERT_EQ(stream.push(start, PathTime{0}), SegmentStream::Verdict::kAccepted);
    for (int i = 0; i < 60; ++i) {
      const auto units = static_cast<std::uint16_t>(1 + random() % 500);
      const auto a = static_cast<std::int32_t>(random() % 200'000) - 100'000;
      ASSERT_EQ(stream.push(segment(next(), units, a, -a / 3), PathTime{0}),
                SegmentStream::Verdict::kAccepted);
    }
    stream.advance_to(PathTime{static_cast<std::int64_t>(random() % 100'000)});
    SegmentStream::Preview preview(stream);
    std::int64_t at = 100'000;
    for (int i = 0; i < 200; ++i, at += static_cast<std::int64_t>(random() % 20'000)) {
      preview.advance_to(PathTime{at});
      SegmentStream walked = stream;
      walked.advance_to(PathTime{at});
      for (int axis = 0; axis < 2; ++axis) ASSERT_EQ(preview.position(axis), walked.position(axis));
    }
  }
}

// Renews the plan as the board does, and compares it with the node all the while.
struct PlanWatch {
  Bench& bench;
  MotionPlanExchange exchange;
  LocalTime start{0};
  double worst = 0, worst_step = 0, last = 0;
  bool first = true;

  void renew() {
    start = bench.local();
    exchange.renew(bench.node(), start, 0xFFFF'F000);  // across the end of 32 bits too
  }
  void look() {
    const LocalTime now = bench.local();
    const PlanCounts counts = 0xFFFF'F000 + static_cast<PlanCounts>((now - start).count() / 250);
    for (int axis = 0; axis < 2; ++axis) {
      const auto exact = static_cast<double>(bench.node().position(start + (now - start) / 250 * 250, axis));
      const auto planned = static_cast<double>(exchange.current().at(axis, counts).position);
      worst = std::max(worst, std::abs(planned - exact) / 4294967296.0);
      if (axis == 0 && !first) worst_step = std::max(worst_step, std::abs(planned - last) / 4294967296.0);
      if (axis == 0) last = planned;
    }
    first = false;
  }
};

TEST(MotionPlan, FollowsAProfileMotionWithinATenthOfACount) {
  Bench bench(std::vector<NodeSetup>{{.id = 1}});
  bench.enable(1, 0, 1);
  bench.write(1, 0x6081, 0, 4, 400'000);
  bench.write(1, 0x6083, 0, 4, 6'400'000);
  bench.write(1, 0x6084, 0, 4, 6'400'000);
  bench.write(1, 0x607A, 0, 4, 100'000);
  bench.write(1, 0x6040, 0, 2, 0x1F);
  PlanWatch watch{bench, {}};
  for (int i = 0; i < 400; ++i) {
    watch.renew();
    bench.run(1ms, 50us, [&] { watch.look(); });
  }
  EXPECT_EQ(bench.position(0, 0), from_counts(100'000));
  EXPECT_LT(watch.worst, kMostDifference);
}

TEST(MotionPlan, FollowsAStreamAndItsStopWithinATenthOfACount) {
  Bench bench(std::vector<NodeSetup>{{.id = 1, .drift_ppm = 30}});
  bench.bring_up();
  bench.write(1, 0x2115, 0, 2, 5);
  for (int axis = 0; axis < 2; ++axis) bench.enable(1, axis, 7);
  std::uint8_t sequence = 0;
  const auto send = [&](std::uint64_t raw) {
    CanFrame frame{.id = 0x401, .length = 8};
    put_u64_le(frame.data, raw);
    bench.send(frame);
  };
  const std::int64_t tau = bench.node().path_time(bench.local()).count() / kPathTicksPerUnit;
  send(encode(Segment{.sequence = sequence++, .control = SegmentControl::kStart, .start_units = tau + 1000}));
  for (int i = 0; i < 12; ++i)
    for (const int sign : {1, -1, -1, 1}) send(segment(sequence++, 1250, sign * 800'000, -sign * 300'000));
  bench.run(50ms);
  bench.rate(1.0);
  PlanWatch watch{bench, {}};
  for (int i = 0; i < 1100; ++i) {
    watch.renew();
    // Starved near the end: the stop of that is followed too.
    bench.run(1ms, 50us, [&] { watch.look(); });
  }
  EXPECT_LT(watch.worst, kMostDifference + 0.6) << "a stop that comes within a plan is in the next";
  EXPECT_TRUE(bench.node().path().stop_latched());
}

TEST(MotionPlan, IsOutdatedWhenAMotionBeginsAndNotBefore) {
  Bench bench(std::vector<NodeSetup>{{.id = 1}});
  bench.enable(1, 0, 1);
  MotionPlanExchange exchange;
  exchange.renew(bench.node(), bench.local(), 1000);
  const LocalTime start = bench.local();
  const auto counts = [&] { return 1000 + static_cast<PlanCounts>((bench.local() - start).count() / 250); };
  bench.send("701#05");
  bench.run(500us);
  EXPECT_FALSE(exchange.outdated(bench.node(), bench.local(), counts()));
  bench.write(1, 0x607A, 0, 4, 100'000);
  exchange.renew(bench.node(), bench.local(), counts());
  bench.send("601#2B4060001F000000");
  bench.run(200us);
  EXPECT_TRUE(exchange.outdated(bench.node(), bench.local(), counts()));
  exchange.renew(bench.node(), bench.local(), counts());
  EXPECT_FALSE(exchange.outdated(bench.node(), bench.local(), counts()));
  bench.run(5ms);
  EXPECT_TRUE(exchange.outdated(bench.node(), bench.local(), counts())) << "its time is over";
}

TEST(MotionPlan, ALatePlanFadesToAStandstill) {
  MotionPlan plan;
  for (auto& pieces : plan.pieces)
    for (int i = 0; i < MotionPlan::kUsualPieces; ++i)
      pieces[static_cast<std::size_t>(i)] = {i * kOneCount * 100, kOneCount * 100, 0};
  std::int64_t last = 0, last_step = 100 * kOneCount / 64;
  for (PlanCounts t = 0; t < 300'000; t += 32) {
    const auto point = plan.at(1, t);
    const std::int64_t step = point.position - last;
    if (t > 0) {
      ASSERT_LE(std::abs(step - last_step), kOneCount / 64) << t;
      last_step = step;
    }
    last = point.position;
  }
  EXPECT_EQ(last_step, 0);
  EXPECT_EQ(plan.at(0, 299'000).velocity, 0);
  EXPECT_TRUE(plan.late(MotionPlan::horizon(MotionPlan::kUsualPieces)));
  EXPECT_FALSE(plan.late(MotionPlan::horizon(MotionPlan::kUsualPieces) - 1));
}

}  // namespace
}  // namespace kinebus::testing_bench
