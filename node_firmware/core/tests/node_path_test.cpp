// Path time, its clock and its stream on one node: what starts, what is refused, what is told.

#include "node_firmware/core/tests/lone_bench.hpp"
#include "node_firmware/core/tests/stream_bench.hpp"

namespace kinebus::testing_bench {
namespace {

using Flags = StreamStatus;

struct PathTest : LoneStreamTest {
  bool runs() { return lone.node.path_rate_q32(lone.now) != 0; }
  /// SYNC stays away for so long.
  void lose_sync(BusTime span = 300ms) { lone.wait(span); }
};

TEST_F(PathTest, RecordsThatComeWhilePathTimeRunsAreWatchedToo) {
  follow();
  lone.rate(1);
  queue({600'000, 0, 0}, 3'000);
  const std::int64_t end = state.position;
  lone.run(300ms);
  EXPECT_TRUE(lone.stopped()) << "no record comes after them";
  EXPECT_EQ(lone.told(node_emcy::kStarved), 1);
  EXPECT_EQ(lone.counter(NodeCounter::kUnderruns), 1);
  const std::int64_t here = lone.node.user_position(lone.now, 0);
  EXPECT_GT(here, 0);
  EXPECT_LT(here, end) << "before their end: the way is still there";
  lone.run(100ms);
  EXPECT_EQ(lone.node.user_position(lone.now, 0), here);
  EXPECT_EQ(lone.told(node_emcy::kStarved), 1);
  // So the rest can follow.
  state = advance(state, -600'000, 1250, kDefaultAccelerationShift);
  record({.duration = 1250, .acceleration = {-600'000, 0}});
  record({.control = SegmentControl::kEnd});
  lone.clear_stop();
  lone.rate(1);
  lone.run(200ms);
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.node.user_position(lone.now, 0), state.position);
}

TEST_F(PathTest, AStopInTheMidstOfRecordsIsNotTakenForStarvation) {
  follow();
  queue({600'000, 0, 0});
  lone.rate(1);
  lone.broadcast(RateCommand::Kind::kStop);
  ASSERT_TRUE(lone.stopped());
  lone.run(300ms);
  EXPECT_EQ(lone.told(node_emcy::kStarved), 0);
  EXPECT_EQ(lone.counter(NodeCounter::kUnderruns), 0);
}

TEST_F(PathTest, AnAxisThatIsSwitchedOffInTheMidstOfTheStreamStopsAll) {
  follow();
  queue({600'000, 0, 0, 0, 0, 0, 0});
  lone.rate(1);
  lone.run(20ms);
  ASSERT_FALSE(lone.stopped());
  lone.unpower(1);
  lone.run(20ms);
  EXPECT_TRUE(lone.stopped());
  EXPECT_EQ(lone.told(node_emcy::kStream), 1);
  EXPECT_FALSE(runs());
  EXPECT_TRUE(lone.node.drive(0).power);
}

TEST_F(PathTest, WhatIsQueuedForAnAxisThatWasSwitchedOffMeanwhileDoesNotMoveTheOther) {
  follow();
  queue({600'000, 0, 0});
  lone.unpower(0);
  lone.run(20ms);
  EXPECT_FALSE(lone.stopped()) << "all rests";
  lone.power(0);
  lone.control(0x0F, 0);
  lone.rate(1);
  lone.run(50ms);
  EXPECT_TRUE(lone.stopped());
  EXPECT_EQ(lone.told(node_emcy::kStream), 1);
  EXPECT_LT(lone.node.path_time(lone.now).count(), 62'500 * kPathTicksPerUnit);
  EXPECT_EQ(counts(0), 0);
  // Dropped, and sent anew, it moves.
  EXPECT_EQ(lone.write(0x60C4, 6, 1, 0), 0u);
  lone.clear_stop();
  sequence = 0;
  state = {};
  queue({600'000, -600'000}, 1'000);
  record({.control = SegmentControl::kEnd});
  lone.rate(1);
  lone.run(200ms);
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.node.user_position(lone.now, 0), state.position);
}

TEST_F(PathTest, AHoldBehindAStopAsksForNoOtherAndAStartDoes) {
  lone.broadcast(RateCommand::Kind::kStop);
  lone.rate(0);
  EXPECT_EQ(lone.told(node_emcy::kCommand), 0);
  lone.rate(0.5);
  EXPECT_EQ(lone.told(node_emcy::kCommand), 1);
  EXPECT_FALSE(runs());
}

TEST(NodePath, WithoutBusTimeAHoldIsTakenAndAStartIsAnsweredByAStop) {
  Lone lone;
  lone.send("000#0101");
  lone.rate(0);
  EXPECT_FALSE(lone.stopped());
  lone.rate(0.5);
  EXPECT_TRUE(lone.stopped());
  EXPECT_EQ(lone.told(emcy::kSyncController), 1);
  EXPECT_EQ(lone.node.path_rate_q32(lone.now), 0u);
}

TEST_F(PathTest, AStreamsErrorIsShownUntilItsStopIsCleared) {
  const auto refused = [&] {
    sequence = 0;
    record({.duration = 100});  // no start before it
  };
  refused();
  EXPECT_TRUE(lone.stopped());
  EXPECT_TRUE(lone.stream_flags() & Flags::kSequenceError);
  refused();
  lone.run(20ms);
  EXPECT_EQ(lone.told(node_emcy::kStream), 1) << "once";
  EXPECT_EQ(lone.counter(NodeCounter::kSequenceErrors), 2);
  lone.rate(0);
  EXPECT_TRUE(lone.stream_flags() & Flags::kSequenceError) << "a hold clears nothing";
  lone.clear_stop();
  EXPECT_FALSE(lone.stream_flags() & (Flags::kSequenceError | Flags::kStopped));
  refused();
  EXPECT_TRUE(lone.stopped()) << "anew";
  lone.run(20ms);
  EXPECT_EQ(lone.told(node_emcy::kStream), 2);
}

TEST_F(PathTest, AClearInTheMidstOfTheStopsRampIsRefused) {
  ASSERT_EQ(lone.write(0x2113, 0, 2, 510), 0u);
  lone.rate(1);
  lone.node.on_axis_trouble(lone.now, 0, emcy::kEncoder);
  lone.run(50ms);
  ASSERT_TRUE(runs());
  lone.clear_stop();
  EXPECT_TRUE(lone.stopped());
  lone.run(600ms);
  ASSERT_FALSE(runs());
  EXPECT_TRUE(lone.stopped());
  lone.clear_stop();
  EXPECT_FALSE(lone.stopped());
}

TEST_F(PathTest, SyncThatIsLostTwiceStopsTwice) {
  for (int times = 1; times <= 2; ++times) {
    lone.rate(1);
    ASSERT_TRUE(runs());
    EXPECT_TRUE(lone.stream_flags() & Flags::kSynchronised);
    lose_sync();
    EXPECT_TRUE(lone.stopped()) << times;
    EXPECT_FALSE(runs());
    EXPECT_EQ(lone.told(emcy::kSyncController), times);
    EXPECT_EQ(lone.counter(NodeCounter::kSyncLost), times);
    EXPECT_FALSE(lone.stream_flags() & Flags::kSynchronised);
    lone.run(100ms);
    lone.clear_stop();
    EXPECT_FALSE(lone.stopped());
  }
}

TEST_F(PathTest, SyncThatIsLostWhileAllRestsIsCountedAndStopsNobody) {
  lose_sync();
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.counter(NodeCounter::kSyncLost), 1);
  lose_sync();
  EXPECT_EQ(lone.counter(NodeCounter::kSyncLost), 1) << "once";
}

TEST_F(PathTest, TheFlagsTellWhetherRecordsAreExecuted) {
  EXPECT_EQ(Lone().stream_flags(), Flags::kAtRest);
  EXPECT_EQ(lone.stream_flags(), Flags::kAtRest | Flags::kSynchronised);
  follow();
  queue({600'000, -600'000});
  record({.control = SegmentControl::kEnd});
  EXPECT_FALSE(lone.stream_flags() & Flags::kAtRest);
  lone.rate(1);
  EXPECT_TRUE(lone.stream_flags() & Flags::kRunning);
  EXPECT_FALSE(lone.stream_flags() & Flags::kAtRest);
  lone.run(100ms);
  EXPECT_EQ(lone.stream_flags(), Flags::kAtRest | Flags::kSynchronised);
}

TEST_F(PathTest, AnNmtStartInMotionStopsNobody) {
  follow();
  queue({600'000, 0, 0, 0, -600'000});
  record({.control = SegmentControl::kEnd});
  lone.rate(1);
  lone.run(20ms);
  lone.send("000#0101");
  lone.run(300ms);
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.node.user_position(lone.now, 0), state.position);
}

TEST_F(PathTest, WithAGatewayAnNmtStopIsAStopOfAllAndNot6007h) {
  ASSERT_EQ(lone.write(0x6007, 0, 2, 1), 0u);  // else a fault
  lone.start_move();
  lone.send("000#0201");
  lone.run(100ms);
  EXPECT_TRUE(lone.stopped());
  EXPECT_FALSE(lone.node.moving(lone.now));
  lone.send("000#8001");
  EXPECT_EQ(lone.read(0x6041, 0) & 0x6F, 0x27) << "no fault";
  EXPECT_EQ(lone.told(node_emcy::kCommand), 1);
}

TEST(NodePath, WithoutAGatewayAnNmtStartLetsAMotionGoOn) {
  Lone lone;
  lone.start_move();
  lone.send("000#0101");
  lone.wait(5s);
  EXPECT_EQ(lone.read(0x6064, 0), 50'000);
}

TEST_F(PathTest, ASyncOfAnotherLengthIsNoneAndIsToldOnce) {
  const std::int64_t before = lone.counter(NodeCounter::kRxMalformed);
  for (int i = 0; i < 3; ++i) lone.send("080#");
  EXPECT_EQ(lone.counter(NodeCounter::kRxMalformed), before + 3);
  EXPECT_EQ(lone.told(emcy::kSyncLength), 1);
  lone.rate(1);
  for (int i = 0; i < 60; ++i) {
    lone.send("080#");
    lone.wait(4ms);
  }
  EXPECT_TRUE(lone.stopped()) << "it has not heard a SYNC";
}

TEST(NodeLssPath, AnIdIsInForceFromTheNextResetOfCommunicationOn) {
  Lone lone;
  lone.send("7E5#0401000000000000");
  lone.send("7E5#1104000000000000");
  lone.send("7E5#0400000000000000");
  EXPECT_EQ(lone.node.node_id(), 1);
  lone.send("000#8201");
  EXPECT_EQ(lone.node.node_id(), 4);
  EXPECT_EQ(lone.read(0x1014, 0), 0x84);
  EXPECT_EQ(lone.read(0x1800, 1) & 0x7F, 4);
}

TEST(NodeLssPath, ANodeThatGetsItsFirstIdBeginsWithIt) {
  Lone lone(NodeOptions{});
  lone.send("7E5#0401000000000000");
  lone.send("7E5#1104000000000000");
  lone.send("7E5#0400000000000000");
  EXPECT_EQ(lone.node.node_id(), 4);
  EXPECT_EQ(lone.node.nmt_state(), NmtState::kPreOperational);
  EXPECT_EQ(lone.read(0x1014, 0), 0x84);
  EXPECT_EQ(lone.read(0x6041, 0) & 0x6F, 0x40);
}

TEST(NodeLssPath, WhoHasItsIdFromItsBoardDoesNotHearLss) {
  Lone lone({.node_id = 1, .id_from_board = true});
  lone.send("7E5#0401000000000000");
  lone.send("7E5#1104000000000000");
  lone.send("7E5#1700000000000000");
  lone.send("000#8201");
  EXPECT_EQ(lone.node.node_id(), 1);
  EXPECT_TRUE(lone.node.image_to_store().empty());
  EXPECT_TRUE(
      std::none_of(lone.seen.begin(), lone.seen.end(), [](const CanFrame& f) { return f.id == 0x7E4; }));
}

}  // namespace
}  // namespace kinebus::testing_bench
