// Three nodes with different crystals: the stream and path time.

#include "node_firmware/core/tests/stream_bench.hpp"

namespace kinebus::testing_bench {
namespace {

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

TEST_F(StreamTest, RecordsThatWereExchangedOnTheirWayMoveTheSame) {
  start_all(1000);
  wave(6, false);
  bench.run(50ms);
  bench.rate(1.0);
  watch(150ms);
  const CanFrame first = feeds[1].segment(1250, 50'000, 0);
  const CanFrame second = feeds[1].segment(1250, -50'000, 0);
  const CanFrame third = feeds[1].end();
  bench.send(third);
  bench.send(second);
  watch(2ms);
  bench.send(first);
  for (Feed* other : {&feeds[0], &feeds[2]}) bench.send(other->end());
  watch(900ms);
  expect_at_feeds_end();
  EXPECT_FALSE(status(1).flags & (StreamStatus::kStopped | StreamStatus::kSequenceError));
  EXPECT_TRUE(status(1).flags & StreamStatus::kReordered);
  EXPECT_FALSE(status(0).flags & StreamStatus::kReordered);
  EXPECT_EQ(bench.read(2, 0x2120, static_cast<std::uint8_t>(NodeCounter::kRecordsReordered)), 2);
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
  move_through_wave(8, 200ms);
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
