// Three nodes with different crystals: the stream, path time, and the stops that they make together.

#include "node_firmware/core/tests/node_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr int kNodes = 3;
// After a second of SYNCs; it falls with their number (clock_estimate_test measures that).
constexpr double kSkewUs = 4.0;

/// The gateway's side of one node's stream: exact states, sequence, credit.
struct Feed {
  std::uint8_t id = 1;
  std::uint8_t sequence = 0;
  std::array<AxisState, 2> state{};
  std::int64_t knot_units = 0;

  std::uint8_t next() {
    const std::uint8_t n = sequence;
    sequence = static_cast<std::uint8_t>((sequence + 1) % kSequenceModulus);
    return n;
  }
  CanFrame frame(std::uint32_t base, std::uint64_t raw) const {
    CanFrame f{.id = base + id, .length = 8};
    put_u64_le(f.data, raw);
    return f;
  }
  CanFrame start(std::int64_t units) {
    knot_units = units;
    return frame(
        0x400, encode(Segment{.sequence = next(), .control = SegmentControl::kStart, .start_units = units}));
  }
  CanFrame end() {
    return frame(0x400, encode(Segment{.sequence = next(), .control = SegmentControl::kEnd}));
  }
  CanFrame segment(std::uint16_t units, std::int32_t a, std::int32_t b) {
    state[0] = advance(state[0], a, units, kDefaultAccelerationShift);
    state[1] = advance(state[1], b, units, kDefaultAccelerationShift);
    knot_units += units;
    return frame(0x400, encode(Segment{.sequence = next(), .duration = units, .acceleration = {a, b}}));
  }
  CanFrame checkpoint(int axis) const {
    return frame(0x500, encode(Checkpoint{sequence, static_cast<std::uint8_t>(axis),
                                          state[static_cast<std::size_t>(axis)].position}));
  }
};

std::vector<NodeSetup> three() {
  return {{.id = 1, .drift_ppm = 40, .offset = 123ms},
          {.id = 2, .drift_ppm = -35, .offset = 98'765us},
          {.id = 3, .drift_ppm = 5, .offset = 7s}};
}

struct StreamTest : testing::Test {
  StreamTest() : bench(three()) {
    for (int i = 0; i < kNodes; ++i) feeds[static_cast<std::size_t>(i)].id = static_cast<std::uint8_t>(i + 1);
    bench.bring_up();
    for (int id = 1; id <= kNodes; ++id) {
      bench.write(static_cast<std::uint8_t>(id), 0x2115, 0, 2, 5);  // starvation margin 5 ms
      for (int axis = 0; axis < 2; ++axis) bench.enable(static_cast<std::uint8_t>(id), axis, 7);
    }
  }
  std::int64_t tau_units() { return bench.node().path_time(bench.local()).count() / kPathTicksPerUnit; }

  /// A wave that comes back to its start: every node with other accelerations, `blocks` times 4 x 20 ms.
  void start_all(std::int64_t ahead_units) {
    const std::int64_t at = tau_units() + ahead_units;
    for (Feed& feed : feeds) bench.send(feed.start(at));
  }
  void wave(int blocks, bool checkpoints = true) {
    for (int i = 0; i < blocks; ++i)
      for (const int sign : {1, -1, -1, 1})
        for (Feed& feed : feeds) {
          if (checkpoints) bench.send(feed.checkpoint(i & 1));
          bench.send(feed.segment(1250, sign * (600'000 + 1000 * feed.id), -sign * 250'000 * feed.id));
        }
  }
  void end_all() {
    for (Feed& feed : feeds) bench.send(feed.end());
  }
  StreamStatus status(int i) {
    const CanFrame* frame = bench.last(0x281u + static_cast<unsigned>(i));
    return frame == nullptr ? StreamStatus{} : decode_stream_status(get_u64_le(frame->data));
  }
  /// Largest difference of path time between the nodes now, us.
  double skew_us() {
    std::int64_t low = INT64_MAX, high = INT64_MIN;
    for (std::size_t i = 0; i < kNodes; ++i) {
      const std::int64_t tau = bench.node(i).path_time(bench.local(i)).count();
      low = std::min(low, tau);
      high = std::max(high, tau);
    }
    return static_cast<double>(high - low) / 16;
  }
  /// Runs with eyes on skew and on steps of any axis.
  void watch(BusTime span, double most_skew_us = kSkewUs) {
    std::array<std::array<std::int64_t, 2>, kNodes> last{};
    bool first = true;
    bench.run(span, 500us, [&] {
      EXPECT_LE(skew_us(), most_skew_us) << bench.now.count();
      for (std::size_t i = 0; i < kNodes; ++i)
        for (int axis = 0; axis < 2; ++axis) {
          const std::int64_t here = bench.position(i, axis);
          std::int64_t& before = last[i][static_cast<std::size_t>(axis)];
          // The waves reach 110,000 counts/s: 55 counts in 500 us.
          if (!first) {
            EXPECT_LE(std::abs(here - before), from_counts(60)) << "node " << i + 1;
          }
          before = here;
        }
      first = false;
    });
  }
  bool all_rest() {
    for (std::size_t i = 0; i < kNodes; ++i)
      if (bench.node(i).path_rate_q32(bench.local(i)) != 0) return false;
    return true;
  }
  void expect_stopped_together(double most_skew_us = kSkewUs) {
    EXPECT_TRUE(all_rest());
    EXPECT_LE(skew_us(), most_skew_us);
    for (int i = 0; i < kNodes; ++i) {
      EXPECT_TRUE(status(i).flags & StreamStatus::kStopped) << i;
      EXPECT_TRUE(bench.node(static_cast<std::size_t>(i)).drive(0).power);
      EXPECT_TRUE(bench.node(static_cast<std::size_t>(i)).drive(0).holding);
    }
  }
  void expect_at_feeds_end() {
    for (std::size_t i = 0; i < kNodes; ++i)
      for (int axis = 0; axis < 2; ++axis)
        EXPECT_EQ(bench.node(i).user_position(bench.local(i), axis),
                  feeds[i].state[static_cast<std::size_t>(axis)].position);
  }

  Bench bench;
  std::array<Feed, kNodes> feeds{};
};

TEST_F(StreamTest, ThreeNodesFollowTheirStreamsWithOnePathTime) {
  start_all(1000);
  wave(6);
  end_all();
  bench.run(150ms);
  for (int i = 0; i < kNodes; ++i) {
    EXPECT_EQ(status(i).next_sequence, feeds[static_cast<std::size_t>(i)].sequence);
    EXPECT_TRUE(status(i).flags & StreamStatus::kSynchronised);
  }
  bench.rate(1.0);
  watch(800ms);
  expect_at_feeds_end();
  for (int i = 0; i < kNodes; ++i) {
    EXPECT_EQ(status(i).flags & ~StreamStatus::kSynchronised, StreamStatus::kAtRest);
    EXPECT_EQ(status(i).free_records, SegmentStream::kCapacity);
  }
}

TEST_F(StreamTest, FeedHoldAndOverrideMoveNothingOffThePath) {
  start_all(1000);
  wave(6);
  end_all();
  bench.run(50ms);
  bench.rate(0.6);
  watch(200ms);
  bench.rate(0);
  watch(150ms);
  EXPECT_TRUE(all_rest());
  const std::int64_t there = bench.position(1, 0);
  watch(100ms);
  EXPECT_EQ(bench.position(1, 0), there);
  bench.rate(1.0);
  watch(900ms);
  expect_at_feeds_end();
}

TEST_F(StreamTest, AStarvedNodeStopsAllOnThePathAndTheJobGoesOnFromThere) {
  start_all(1000);
  wave(3, false);
  bench.run(50ms);
  const std::size_t before = bench.seen.size();
  bench.rate(1.0);
  watch(600ms);
  expect_stopped_together();
  EXPECT_TRUE(bench.was_seen(0x081, before) || bench.was_seen(0x082, before) ||
              bench.was_seen(0x083, before));
  // Nobody ran past what it had.
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_LT(bench.node(i).path_time(bench.local(i)), bench.node(i).path().stream().horizon());
    EXPECT_FALSE(bench.node(i).path().stream().underrun());
    EXPECT_TRUE(status(static_cast<int>(i)).flags & StreamStatus::kUnderrun);
  }
  // A resume is refused while the stop is latched.
  bench.rate(1.0);
  watch(100ms);
  expect_stopped_together();
  wave(2);
  end_all();
  bench.command(RateCommand::Kind::kClear);
  bench.run(50ms);
  bench.rate(1.0);
  watch(900ms);
  expect_at_feeds_end();
}

TEST_F(StreamTest, AMissingRecordStopsAllAndTheExpectedOneIsStillTaken) {
  start_all(1000);
  wave(6, false);
  bench.run(50ms);
  bench.rate(1.0);
  watch(150ms);
  Feed& feed = feeds[1];
  const CanFrame lost = feed.segment(1250, 50'000, 0);
  const CanFrame after = feed.segment(1250, -50'000, 0);
  bench.send(after);
  watch(200ms);
  expect_stopped_together();
  EXPECT_TRUE(status(1).flags & StreamStatus::kSequenceError);
  EXPECT_EQ(text_of(*bench.last(0x082)).substr(0, 12), "082#02FF8102");
  bench.send(lost);
  bench.send(after);
  bench.send(feed.end());
  for (Feed* other : {&feeds[0], &feeds[2]}) bench.send(other->end());
  bench.command(RateCommand::Kind::kClear);
  bench.run(50ms);
  bench.rate(1.0);
  watch(900ms);
  // One way of `lost` and its return leave the axis moved, at rest.
  expect_at_feeds_end();
  EXPECT_FALSE(status(1).flags & StreamStatus::kSequenceError);
}

TEST_F(StreamTest, AWrongCheckpointStopsAll) {
  start_all(1000);
  wave(6);
  bench.run(50ms);
  bench.rate(1.0);
  watch(150ms);
  Feed wrong = feeds[2];
  wrong.state[0].position += 512;
  bench.send(wrong.checkpoint(0));
  watch(250ms);
  expect_stopped_together();
  EXPECT_TRUE(status(2).flags & StreamStatus::kCheckpointError);
  EXPECT_FALSE(status(0).flags & StreamStatus::kCheckpointError);
}

TEST_F(StreamTest, AnEndInMotionIsRefusedAndStopsAll) {
  start_all(1000);
  wave(5);
  for (Feed& feed : feeds) bench.send(feed.segment(600, 300'000, 0));
  bench.run(50ms);
  bench.rate(1.0);
  watch(100ms);
  bench.send(feeds[0].end());
  watch(200ms);
  expect_stopped_together();
}

TEST_F(StreamTest, LostSyncStopsAllFromTheSameInstant) {
  start_all(1000);
  wave(8);
  end_all();
  bench.run(50ms);
  bench.rate(1.0);
  watch(150ms);
  bench.stop_sync();
  watch(600ms);
  expect_stopped_together();
  EXPECT_EQ(bench.read(1, 0x2120, 5), 1);
}

TEST_F(StreamTest, OneNodeThatAloneHearsNoSyncStopsTheOthersToo) {
  start_all(1000);
  wave(8);
  end_all();
  bench.run(50ms);
  bench.rate(1.0);
  watch(100ms);
  bench.lose = [](std::size_t node, const CanFrame& frame) { return node == 2 && frame.id == 0x080; };
  watch(450ms);
  expect_stopped_together();
}

TEST_F(StreamTest, AnEmergencyStopInputStopsAllAndCannotBeClearedWhilePressed) {
  bench.write(2, 0x2130, 7, 1, 7);
  start_all(1000);
  wave(6);
  end_all();
  bench.run(50ms);
  bench.rate(1.0);
  watch(200ms);
  bench.node(1).on_switch(bench.local(1), 6, true);
  watch(150ms);
  expect_stopped_together();
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_EQ(bench.node(i).path().counters().late_stops, 0u);
  bench.command(RateCommand::Kind::kClear);
  bench.run(20ms);
  EXPECT_TRUE(bench.node(1).path().stop_latched());
  // The others were cleared; their motion still waits for the one that was not.
  bench.node(1).on_switch(bench.local(1), 6, false);
  bench.run(20ms);
  bench.command(RateCommand::Kind::kClear);
  bench.run(50ms);
  bench.rate(1.0);
  watch(600ms);
  expect_at_feeds_end();
}

TEST_F(StreamTest, AGatewayWithoutHeartbeatIsAnsweredByAStopOfAll) {
  for (std::uint8_t id = 1; id <= kNodes; ++id) bench.write(id, 0x1016, 1, 4, 0x7F0000 | (300 + id));
  bench.send("77F#05");
  start_all(1000);
  wave(8);
  end_all();
  bench.run(50ms);
  bench.rate(1.0);
  watch(600ms);
  expect_stopped_together();
  EXPECT_TRUE(bench.was_seen(0x081));
  EXPECT_EQ(get_u16_le(bench.last(0x081)->data), 0x8130);
}

TEST_F(StreamTest, AFaultOfOneAxisStopsAllOthersOnThePath) {
  start_all(1000);
  wave(6);
  end_all();
  bench.run(50ms);
  bench.rate(1.0);
  watch(200ms);
  bench.node(0).on_drive_fault(bench.local(0), 1, 0x2310);
  watch(150ms);
  EXPECT_TRUE(all_rest());
  EXPECT_LE(skew_us(), kSkewUs);
  EXPECT_FALSE(bench.node(0).drive(1).power);
  EXPECT_TRUE(bench.node(0).drive(0).power);
  EXPECT_TRUE(bench.node(2).drive(0).power);
  // What is queued for the axis without power is worth nothing: resuming stops again, at once.
  bench.command(RateCommand::Kind::kClear);
  bench.run(20ms);
  bench.rate(1.0);
  bench.run(200ms);
  EXPECT_TRUE(all_rest());
}

TEST_F(StreamTest, QuickStopOfOneAxisIsAStopOfAll) {
  start_all(1000);
  wave(6);
  end_all();
  bench.run(50ms);
  bench.rate(1.0);
  watch(200ms);
  CanFrame quick{.id = 0x201, .length = 6};
  quick.data = {0x0B, 0x00, 0x0F, 0x00, 7, 7};
  bench.send(quick);
  watch(150ms);
  expect_stopped_together();
  EXPECT_EQ(bench.statusword(1, 0) & 0x6F, 0x07);
  EXPECT_EQ(bench.statusword(1, 1) & 0x6F, 0x27);
}

TEST_F(StreamTest, AStopByTheGatewayIsCleanAndTheQueueCanBeDropped) {
  start_all(1000);
  wave(6);
  end_all();
  bench.run(50ms);
  bench.rate(1.0);
  watch(200ms);
  bench.command(RateCommand::Kind::kStop);
  watch(150ms);
  expect_stopped_together();
  for (std::uint8_t id = 1; id <= kNodes; ++id) bench.write(id, 0x60C4, 6, 1, 0);
  watch(50ms);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_TRUE(bench.node(i).path().stream().idle());
    EXPECT_EQ(bench.node(i).user_position(bench.local(i), 0) % kOneCount, 0);
    feeds[i].sequence = 0;
    for (std::size_t axis = 0; axis < 2; ++axis)
      feeds[i].state[axis] = {bench.node(i).user_position(bench.local(i), static_cast<int>(axis)), 0};
  }
  bench.command(RateCommand::Kind::kClear);
  bench.run(20ms);
  start_all(2000);
  wave(1);
  end_all();
  bench.run(50ms);
  bench.rate(1.0);
  watch(300ms);
  expect_at_feeds_end();
}

TEST_F(StreamTest, AStartThatComesTooLateMovesNothing) {
  bench.rate(1.0);
  watch(200ms);
  const std::int64_t there = bench.position(0, 0);
  bench.send(feeds[0].start(tau_units() - 10));
  watch(200ms);
  EXPECT_EQ(bench.position(0, 0), there);
  EXPECT_TRUE(all_rest());
  EXPECT_TRUE(status(0).flags & StreamStatus::kSequenceError);
}

TEST_F(StreamTest, AnewGatewayEpochIsJoinedWithoutAStep) {
  start_all(1000);
  wave(8);
  end_all();
  bench.run(50ms);
  bench.rate(1.0);
  watch(200ms);
  bench.rate(0);
  watch(200ms);
  const std::int64_t tau = bench.node(0).path_time(bench.local(0)).count();
  bench.stop_sync();
  bench.run(1s);
  bench.start_epoch(2, 3600s);
  bench.start_sync(20ms);
  bench.run(3s);
  EXPECT_EQ(bench.node(0).path_time(bench.local(0)).count(), tau);
  bench.rate(1.0);
  watch(900ms);
  expect_at_feeds_end();
}

TEST_F(StreamTest, AnOverrunIsToldAtOnceAndNamesAStopThatLiesAhead) {
  start_all(1000);
  wave(8);
  end_all();
  bench.run(50ms);
  bench.rate(1.0, 5ms, 1);
  watch(50ms);
  // From here on node 2 hears nothing, and its next deadline is far.
  bench.lose = [](std::size_t node, const CanFrame&) { return node == 1; };
  bench.run(8ms);
  const std::size_t before = bench.seen.size();
  bench.node(1).on_receive_overrun(bench.local(1), 3);
  const auto start = bench.node(1).path().stop_start();
  ASSERT_TRUE(start);
  EXPECT_GT(*start, bench.local(1) + 1ms);
  bench.run(10us);
  bench.run(1ms);
  EXPECT_TRUE(bench.was_seen(0x082, before));
  bench.lose = {};
  watch(200ms);
  EXPECT_TRUE(all_rest());
}

TEST_F(StreamTest, ANodeThatIsNotSynchronisedKeepsTheOthersFromRunning) {
  Bench fresh(three());
  fresh.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  fresh.run(10ms);
  fresh.rate(1.0);
  fresh.run(200ms);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_TRUE(fresh.node(i).path().stop_latched());
    EXPECT_EQ(fresh.node(i).path_rate_q32(fresh.local(i)), 0u);
  }
}

}  // namespace
}  // namespace kinebus::testing_bench
