// Records that a node does not take, and what stands behind those that it takes.

#include "node_firmware/core/tests/lone_bench.hpp"

namespace kinebus::testing_bench {
namespace {

struct RecordsTest : LoneStreamTest {
  void check(std::uint8_t of_sequence, std::uint8_t axis, std::int64_t position) {
    CanFrame frame{.id = 0x501, .length = 8};
    put_u64_le(frame.data, encode(Checkpoint{of_sequence, axis, position}));
    lone.send(frame);
  }
  void end() { record({.control = SegmentControl::kEnd}); }
  void expect_refused(std::uint16_t code = node_emcy::kStream) {
    lone.run(20ms);
    EXPECT_TRUE(lone.stopped());
    EXPECT_EQ(lone.told(code), 1);
    lone.clear_stop();
    lone.rate(1);
    lone.run(50ms);
    EXPECT_EQ(counts(0), 0);
    EXPECT_EQ(counts(1), 0);
  }
  int next_sequence() {
    return decode_stream_status(static_cast<std::uint64_t>(lone.read(0x2102, 0))).next_sequence;
  }
};

/// A way up or down, at 87,300 counts/s in its midst.
class FastRecords : public RecordsTest, public testing::WithParamInterface<int> {};

TEST_P(FastRecords, AreRefusedBeyond607FhBeforeAnythingMoves) {
  ASSERT_EQ(lone.write(0x607F, 0, 4, 86'000), 0u);
  follow();
  queue({GetParam() * 600'000, -GetParam() * 600'000}, 1'000);
  expect_refused();
}

TEST_P(FastRecords, AreTakenWithinIt) {
  ASSERT_EQ(lone.write(0x607F, 0, 4, 89'000), 0u);
  follow();
  queue({GetParam() * 600'000, -GetParam() * 600'000}, 1'000);
  end();
  lone.rate(1);
  lone.run(200ms);
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.node.user_position(lone.now, 0), state.position);
  EXPECT_GT(GetParam() * counts(), 1'700);
}

TEST_P(FastRecords, AreNotBoundByATravelOfWhichNobodyKnowsWhereItIs) {
  ASSERT_EQ(lone.write(0x607D, 1, 4, -500), 0u);
  ASSERT_EQ(lone.write(0x607D, 2, 4, 500), 0u);
  follow();
  queue({GetParam() * 600'000, -GetParam() * 600'000}, 1'000);
  end();
  lone.rate(1);
  lone.run(200ms);
  EXPECT_FALSE(lone.stopped());
  EXPECT_GT(GetParam() * counts(), 1'700);
}
INSTANTIATE_TEST_SUITE_P(BothWays, FastRecords, testing::Values(1, -1));

TEST_F(RecordsTest, AreOfTheAccelerationShiftThatTheAxisHasWhenItJoins) {
  ASSERT_EQ(lone.write(0x2140, 1, 1, 4), 0u);
  follow();
  AxisState expected{};
  queue({100'000, -100'000}, 1'000);
  for (const int a : {100'000, -100'000}) expected = advance(expected, a, 1250, 4);
  end();
  lone.rate(1);
  lone.run(200ms);
  EXPECT_EQ(lone.node.user_position(lone.now, 0), expected.position);
  EXPECT_NE(expected.position, state.position);
}

TEST_F(RecordsTest, OfAKindThatIsNoneAreRefused) {
  follow();
  record({.control = static_cast<SegmentControl>(3)});
  expect_refused();
}

TEST_F(RecordsTest, AStartBeforeTheEndOfWhatIsQueuedIsRefused) {
  follow();
  queue({0, 0}, 5'000);
  end();
  record({.control = SegmentControl::kStart,
          .start_units = lone.node.path_time(lone.now).count() / kPathTicksPerUnit + 5'100});
  expect_refused();
}

TEST_F(RecordsTest, AStartInTheMidstOfOthersIsRefused) {
  follow();
  queue({0, 0}, 5'000);
  record({.control = SegmentControl::kStart,
          .start_units = lone.node.path_time(lone.now).count() / kPathTicksPerUnit + 50'000});
  expect_refused();
}

TEST_F(RecordsTest, ACheckpointAheadOfItsRecordIsComparedWhenThatComes) {
  follow();
  queue({}, 1'000);
  const AxisState after = advance({}, 600'000, 1250, kDefaultAccelerationShift);
  check(static_cast<std::uint8_t>(sequence + 1), 0, after.position);
  check(static_cast<std::uint8_t>(sequence + 1), 1, 0);
  record({.duration = 1250, .acceleration = {600'000, 0}});
  lone.run(20ms);
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.counter(NodeCounter::kCheckpointErrors), 0);
  // It has been compared: the next record is no business of it.
  record({.duration = 1250, .acceleration = {600'000, 0}});
  lone.run(20ms);
  EXPECT_FALSE(lone.stopped());
}

class WrongCheckpoint : public RecordsTest, public testing::WithParamInterface<std::uint8_t> {};

TEST_P(WrongCheckpoint, OneOfTwoAheadStopsAll) {
  follow();
  queue({}, 1'000);
  for (const std::uint8_t axis : {std::uint8_t{0}, std::uint8_t{1}})
    check(static_cast<std::uint8_t>(sequence + 1), axis, axis == GetParam() ? from_counts(7) : 0);
  EXPECT_FALSE(lone.stopped());
  record({.duration = 1250});
  EXPECT_TRUE(lone.stream_flags() & StreamStatus::kCheckpointError);
  EXPECT_EQ(lone.counter(NodeCounter::kCheckpointErrors), 1);
  expect_refused(node_emcy::kCheckpoint);
}
INSTANTIATE_TEST_SUITE_P(BothAxes, WrongCheckpoint, testing::Values(std::uint8_t{0}, std::uint8_t{1}));

TEST_F(RecordsTest, WhatCameBeforeItsTurnIsForgottenWithTheBuffer) {
  follow();
  queue({}, 20'000);
  sequence = 2;
  record({.duration = 1250, .acceleration = {600'000, 0}});  // its turn comes behind one more
  EXPECT_EQ(next_sequence(), 1);
  ASSERT_EQ(lone.write(0x60C4, 6, 1, 0), 0u);
  EXPECT_EQ(next_sequence(), 0);
  sequence = 0;
  queue({}, 20'000);
  record({.duration = 1250});
  EXPECT_EQ(next_sequence(), 2) << "not the one of before";
  EXPECT_FALSE(lone.stopped());
}

TEST_F(RecordsTest, AGapThatIsNotFilledIsTold) {
  follow();
  queue({}, 20'000);
  sequence = 3;
  record({.duration = 1250});
  EXPECT_FALSE(lone.stopped()) << "frames may be exchanged on their way";
  lone.run(20ms);
  EXPECT_TRUE(lone.stopped());
  EXPECT_EQ(lone.told(node_emcy::kSequence), 1);
  EXPECT_EQ(lone.counter(NodeCounter::kSequenceErrors), 1);
  // What comes in its order is taken from there on, and the one that was early counts no more.
  lone.clear_stop();
  sequence = 1;
  for (int i = 0; i < 2; ++i) record({.duration = 1000});
  EXPECT_EQ(next_sequence(), 3);
}

TEST_F(RecordsTest, MoreThanThereIsRoomForIsAnOverflowAndStopsAll) {
  follow();
  queue({}, 20'000);
  for (int i = 0; i < SegmentStream::kCapacity; ++i) {
    record({.duration = 1});
    sequence = static_cast<std::uint8_t>(sequence % kSequenceModulus);
  }
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.read(0x60C4, 4), SegmentStream::kCapacity);
  record({.duration = 1});
  EXPECT_TRUE(lone.stopped());
  EXPECT_EQ(lone.counter(NodeCounter::kQueueOverflows), 1);
  EXPECT_EQ(lone.read(0x60C4, 4), SegmentStream::kCapacity);
}

}  // namespace
}  // namespace kinebus::testing_bench
