#include "node_firmware/core/segment_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace kinebus {
namespace {

using Verdict = SegmentStream::Verdict;

/// Makes records as the gateway does, and keeps the exact state that they lead to.
class Source {
 public:
  std::uint64_t start(std::int64_t units) {
    return encode(Segment{.sequence = next(), .control = SegmentControl::kStart, .start_units = units});
  }
  std::uint64_t end() { return encode(Segment{.sequence = next(), .control = SegmentControl::kEnd}); }
  std::uint64_t segment(std::uint16_t units, std::int32_t a, std::int32_t b) {
    state[0] = advance(state[0], a, units, kDefaultAccelerationShift);
    state[1] = advance(state[1], b, units, kDefaultAccelerationShift);
    return encode(Segment{.sequence = next(), .duration = units, .acceleration = {a, b}});
  }
  std::uint64_t checkpoint(int axis) const {
    return encode(Checkpoint{sequence, static_cast<std::uint8_t>(axis),
                             state[static_cast<std::size_t>(axis)].position});
  }
  std::uint8_t next() {
    const std::uint8_t now = sequence;
    sequence = static_cast<std::uint8_t>((sequence + 1) % kSequenceModulus);
    return now;
  }
  std::uint8_t sequence = 0;
  std::array<AxisState, 2> state{};
};

PathTime units(std::int64_t n) {
  return PathTime{n * kPathTicksPerUnit};
}

struct SegmentStreamTest : testing::Test {
  SegmentStreamTest() {
    stream.set_following(0, true);
    stream.set_following(1, true);
  }
  void accept(std::uint64_t raw) { ASSERT_EQ(stream.push(raw, PathTime{0}), Verdict::kAccepted); }
  SegmentStream stream;
  Source source;
};

TEST_F(SegmentStreamTest, KnotsAreExactAndBetweenThemPositionIsThatOfTheContract) {
  std::mt19937 random(3);
  std::vector<std::array<AxisState, 2>> knots;
  std::vector<std::int64_t> times;
  std::vector<Segment> segments;
  std::int64_t time = 100;
  accept(source.start(time));
  for (int i = 0; i < 60; ++i) {
    const auto duration = static_cast<std::uint16_t>(1 + random() % 2000);
    const auto a = static_cast<std::int32_t>(random() % 20001) - 10000;
    const auto b = static_cast<std::int32_t>(random() % 20001) - 10000;
    knots.push_back(source.state);
    times.push_back(time);
    segments.push_back({.duration = duration, .acceleration = {a, b}});
    accept(source.segment(duration, a, b));
    time += duration;
  }
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (int k = 0; k < 5; ++k) {
      const std::int64_t into =
          k == 0 ? 0 : static_cast<std::int64_t>(random()) % (std::int64_t{256} * segments[i].duration);
      if (k != 0 && into < k) continue;
      SegmentStream copy = stream;
      ASSERT_TRUE(copy.advance_to(units(times[i]) + PathTime{into}));
      for (int axis = 0; axis < 2; ++axis)
        EXPECT_EQ(copy.position(axis), position_at(knots[i][static_cast<std::size_t>(axis)],
                                                   segments[i].acceleration[static_cast<std::size_t>(axis)],
                                                   into, kDefaultAccelerationShift));
    }
  // Walking in small steps gives the same as one leap.
  SegmentStream leap = stream;
  const PathTime goal = units(times.back()) + PathTime{100};
  ASSERT_TRUE(leap.advance_to(goal));
  for (PathTime t{0}; t <= goal; t += PathTime{997}) ASSERT_TRUE(stream.advance_to(t));
  ASSERT_TRUE(stream.advance_to(goal));
  EXPECT_EQ(stream.position(0), leap.position(0));
  EXPECT_EQ(stream.velocity(1), leap.velocity(1));
}

TEST_F(SegmentStreamTest, StandsUntilStartAndAfterEnd) {
  accept(source.start(1000));
  accept(source.segment(100, 5000, -2500));
  accept(source.segment(100, -5000, 2500));
  accept(source.end());
  EXPECT_FALSE(stream.open());
  ASSERT_TRUE(stream.advance_to(units(1000)));
  EXPECT_EQ(stream.position(0), 0);
  EXPECT_FALSE(stream.idle());
  ASSERT_TRUE(stream.advance_to(units(5000)));
  EXPECT_EQ(stream.position(0), source.state[0].position);
  EXPECT_TRUE(stream.idle());
  EXPECT_EQ(stream.consumed(), 4u);
  EXPECT_EQ(stream.free_records(), SegmentStream::kCapacity);

  // The next motion starts where the last one ended.
  ASSERT_EQ(stream.push(source.start(6000), units(5000)), Verdict::kAccepted);
  ASSERT_EQ(stream.check(source.checkpoint(0)), Verdict::kAccepted);
  ASSERT_EQ(stream.push(source.segment(10, 100, 0), units(5000)), Verdict::kAccepted);
  ASSERT_TRUE(stream.advance_to(units(5999)));
  EXPECT_EQ(stream.velocity(0), 0);
}

TEST_F(SegmentStreamTest, ARecordThatComesEarlyWaitsForTheOneBeforeIt) {
  accept(source.start(10));
  const std::uint64_t late = source.segment(10, 1, 1);
  const std::uint64_t early = source.segment(10, -1, -1);
  EXPECT_EQ(stream.push(early, PathTime{0}), Verdict::kEarly);
  EXPECT_EQ(stream.push(early, PathTime{0}), Verdict::kDuplicate);
  EXPECT_EQ(stream.push(early ^ (std::uint64_t{1} << 30), PathTime{0}), Verdict::kSequence);
  EXPECT_TRUE(stream.waits_for_order());
  EXPECT_EQ(stream.next_sequence(), 1);
  accept(late);
  EXPECT_FALSE(stream.waits_for_order());
  EXPECT_EQ(stream.push(early, PathTime{0}), Verdict::kDuplicate);
  EXPECT_EQ(stream.next_sequence(), 3);
  EXPECT_EQ(stream.reordered(), 1u);
}

TEST_F(SegmentStreamTest, ARecordBeyondTheWindowIsRefusedAndTheExpectedOneStillAccepted) {
  accept(source.start(10));
  std::array<std::uint64_t, SegmentStream::kOrderWindow + 1> records{};
  for (std::uint64_t& record : records) record = source.segment(10, 1, 1);
  EXPECT_EQ(stream.push(records[SegmentStream::kOrderWindow], PathTime{0}), Verdict::kSequence);
  for (const std::uint64_t record : records) accept(record);
  EXPECT_EQ(stream.reordered(), 0u);
}

TEST_F(SegmentStreamTest, AnyOrderWithinTheWindowIsTheSameMotion) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    std::mt19937 random(seed);
    SegmentStream ordered = stream, shuffled = stream;
    Source feed;
    std::vector<std::uint64_t> records{feed.start(10)};
    for (int i = 0; i < 60; ++i)
      records.push_back(
          feed.segment(100, static_cast<std::int32_t>(random() % 2001) - 1000, 500 - 1000 * (i & 1)));
    for (const std::uint64_t record : records)
      ASSERT_EQ(ordered.push(record, PathTime{0}), Verdict::kAccepted);
    // Every group of a window's length in any order of its own.
    for (std::size_t at = 0; at < records.size(); at += SegmentStream::kOrderWindow) {
      const std::size_t end = std::min<std::size_t>(at + SegmentStream::kOrderWindow, records.size());
      std::shuffle(records.begin() + static_cast<std::ptrdiff_t>(at),
                   records.begin() + static_cast<std::ptrdiff_t>(end), random);
    }
    for (const std::uint64_t record : records) {
      const Verdict verdict = shuffled.push(record, PathTime{0});
      ASSERT_TRUE(verdict == Verdict::kAccepted || verdict == Verdict::kEarly) << "seed " << seed;
    }
    EXPECT_FALSE(shuffled.waits_for_order()) << "seed " << seed;
    EXPECT_EQ(shuffled.size(), ordered.size()) << "seed " << seed;
    for (const int axis : {0, 1})
      EXPECT_EQ(shuffled.tail_state(axis), ordered.tail_state(axis)) << "seed " << seed;
  }
}

TEST_F(SegmentStreamTest, EndInMotionAndMotionWithoutStartAreRefused) {
  EXPECT_EQ(stream.push(encode(Segment{.sequence = 0, .duration = 5}), PathTime{0}), Verdict::kNotStarted);
  accept(source.start(10));
  EXPECT_EQ(stream.push(encode(Segment{.sequence = 1, .control = SegmentControl::kStart, .start_units = 50}),
                        PathTime{0}),
            Verdict::kStartInMotion);
  accept(source.segment(10, 1, 0));
  EXPECT_EQ(stream.push(encode(Segment{.sequence = 2, .control = SegmentControl::kEnd}), PathTime{0}),
            Verdict::kEndInMotion);
}

TEST_F(SegmentStreamTest, AStartForAPathTimeThatHasPassedIsRefused) {
  EXPECT_EQ(stream.push(source.start(10), units(10)), Verdict::kLateStart);
}

TEST_F(SegmentStreamTest, RunningOutInMotionHoldsAtTheKnotAndTakesNothingMoreUntilCleared) {
  accept(source.start(10));
  accept(source.segment(10, 1000, 0));
  EXPECT_FALSE(stream.advance_to(units(25)));
  EXPECT_EQ(stream.position(0), source.state[0].position);
  EXPECT_TRUE(stream.underrun());
  EXPECT_EQ(stream.push(source.segment(10, -1000, 0), units(25)), Verdict::kNotStarted);
  stream.clear(units(25));
  EXPECT_TRUE(stream.idle());
  EXPECT_EQ(stream.next_sequence(), 0);
}

TEST_F(SegmentStreamTest, CheckpointsCompareAtTheirKnotWhereverItIs) {
  accept(source.start(10));
  accept(source.segment(10, 1000, -77));
  const Source middle = source;
  accept(source.segment(20, 500, 3));
  accept(source.segment(30, -900, 5));
  // Ahead of its record, at the end of the queue, and in its middle.
  Source ahead = source;
  const std::uint64_t next = ahead.segment(7, 1, 1);
  EXPECT_EQ(stream.check(ahead.checkpoint(1)), Verdict::kAccepted);
  EXPECT_EQ(stream.check(source.checkpoint(0)), Verdict::kAccepted);
  EXPECT_EQ(stream.check(middle.checkpoint(0)), Verdict::kAccepted);
  EXPECT_EQ(stream.check(middle.checkpoint(1)), Verdict::kAccepted);
  EXPECT_EQ(stream.push(next, PathTime{0}), Verdict::kAccepted);

  // One count of the 24 fractional bits that travel is enough to be seen.
  for (const Source& at : {middle, source}) {
    Source wrong = at;
    wrong.state[0].position += 256;
    EXPECT_EQ(stream.check(wrong.checkpoint(0)), Verdict::kCheckpoint);
  }
  Source wrong_ahead = ahead;
  const std::uint64_t last = wrong_ahead.segment(9, 2, 2);
  wrong_ahead.state[1].position -= 256;
  EXPECT_EQ(stream.check(wrong_ahead.checkpoint(1)), Verdict::kAccepted);
  EXPECT_EQ(stream.push(last, PathTime{0}), Verdict::kCheckpoint);

  ASSERT_TRUE(stream.advance_to(units(10 + 10 + 25)));
  EXPECT_EQ(stream.check(middle.checkpoint(0)), Verdict::kStaleCheckpoint);
}

TEST_F(SegmentStreamTest, CreditIsTheQueueAndMoreIsRefused) {
  accept(source.start(10));
  for (int i = 1; i < SegmentStream::kCapacity; ++i) accept(source.segment(1, 0, 0));
  EXPECT_EQ(stream.free_records(), 0);
  EXPECT_EQ(stream.push(source.segment(1, 0, 0), PathTime{0}), Verdict::kOverflow);
}

TEST_F(SegmentStreamTest, SpeedAndRangeLimitsHoldBeforeAnythingMoves) {
  stream.set_limits(0, {.velocity = 1000, .min_position = -(1LL << 40), .max_position = 1LL << 40});
  accept(source.start(10));
  Source too_fast = source;
  EXPECT_EQ(stream.push(too_fast.segment(200, 1, 0), PathTime{0}), Verdict::kOutOfLimits);
  accept(source.segment(100, 1, 0));
}

TEST_F(SegmentStreamTest, AnAxisThatDoesNotFollowMayOnlyBeToldToRest) {
  stream.set_following(1, false);
  accept(source.start(10));
  accept(source.segment(10, 5, 0));
  EXPECT_EQ(stream.push(source.segment(10, -5, 1), PathTime{0}), Verdict::kNotFollowing);
}

}  // namespace
}  // namespace kinebus
