// SegmentStream at the edge of what it takes, and at the very tick at which something begins or ends.

#include <gtest/gtest.h>

#include "node_firmware/core/segment_stream.hpp"

namespace kinebus {
namespace {

using Verdict = SegmentStream::Verdict;

PathTime units(std::int64_t n) {
  return PathTime{n * kPathTicksPerUnit};
}

struct StreamBounds : testing::Test {
  StreamBounds() {
    for (const int axis : {0, 1}) stream.set_following(axis, true);
  }
  std::uint8_t next() {
    const std::uint8_t now = sequence;
    sequence = static_cast<std::uint8_t>((sequence + 1) % kSequenceModulus);
    return now;
  }
  Verdict push(Segment record) {
    record.sequence = next();
    return stream.push(encode(record), PathTime{0});
  }
  Verdict start(std::int64_t at = 10) { return push({.control = SegmentControl::kStart, .start_units = at}); }
  Verdict end() { return push({.control = SegmentControl::kEnd}); }
  Verdict move(std::uint16_t duration, std::int32_t a, std::int32_t b = 0) {
    const std::array<std::int32_t, 2> accelerations{a, b};
    for (std::size_t i = 0; i < 2; ++i) state[i] = advance(state[i], accelerations[i], duration, 2);
    return push({.duration = duration, .acceleration = {a, b}});
  }
  Verdict check(std::uint8_t at, int axis, std::int64_t position) {
    return stream.check(encode(Checkpoint{at, static_cast<std::uint8_t>(axis), position}));
  }
  SegmentStream stream;
  std::uint8_t sequence = 0;
  std::array<AxisState, 2> state{};
};

TEST_F(StreamBounds, WhatIsExactlyAtALimitIsTakenAndABitMoreIsNot) {
  for (const int sign : {1, -1})
    for (const bool speed : {true, false})
      for (const std::int64_t less : {0, 1}) {
        SCOPED_TRACE(testing::Message() << sign << speed << less);
        SegmentStream other;
        for (const int axis : {0, 1}) other.set_following(axis, true);
        const AxisState after = advance({}, 500, 20, kDefaultAccelerationShift);
        SegmentStream::Limits limits;
        if (speed)
          limits.velocity = after.velocity - less;
        else
          limits.max_position = after.position - less, limits.min_position = less - after.position;
        other.set_limits(1, limits);
        ASSERT_EQ(
            other.push(encode(Segment{.sequence = 0, .control = SegmentControl::kStart, .start_units = 10}),
                       PathTime{0}),
            Verdict::kAccepted);
        EXPECT_EQ(other.push(encode(Segment{.sequence = 1, .duration = 20, .acceleration = {0, 500 * sign}}),
                             PathTime{0}),
                  less == 0 ? Verdict::kAccepted : Verdict::kOutOfLimits);
      }
}

TEST_F(StreamBounds, NothingIsSetInTheMidstOfWhatIsQueued) {
  ASSERT_EQ(start(), Verdict::kAccepted);
  stream.set_limits(0, {.velocity = 0});
  stream.set_shift(0, 7);
  stream.set_rest_position(0, std::int64_t{5} << 32);
  ASSERT_EQ(move(100, 500), Verdict::kAccepted);
  ASSERT_EQ(move(100, -500), Verdict::kAccepted);
  ASSERT_EQ(end(), Verdict::kAccepted);
  stream.set_shift(0, 7);
  ASSERT_TRUE(stream.advance_to(units(10'000)));
  EXPECT_EQ(stream.position(0), state[0].position);
  stream.set_limits(0, {.velocity = 0});
  ASSERT_EQ(start(20'000), Verdict::kAccepted);
  EXPECT_EQ(move(100, 500), Verdict::kOutOfLimits) << "at rest it is set";
}

TEST_F(StreamBounds, WhereItRestsIsWhatItBeginsWithAndWhatACheckpointIsComparedWith) {
  stream.set_rest_position(1, -777);
  EXPECT_EQ(stream.position(1), -777);
  EXPECT_EQ(stream.velocity(1), 0);
  EXPECT_EQ(check(0, 1, -777), Verdict::kAccepted);
  ASSERT_EQ(start(), Verdict::kAccepted);
  EXPECT_EQ(check(1, 1, -777), Verdict::kAccepted);
  EXPECT_EQ(check(0, 1, -777), Verdict::kAccepted) << "behind a record that waits";
  EXPECT_EQ(check(0, 1, -776 + (std::int64_t{3} << 32)), Verdict::kCheckpoint);
  ASSERT_EQ(move(100, 0, 500), Verdict::kAccepted);
  ASSERT_TRUE(stream.advance_to(units(60)));
  EXPECT_EQ(stream.position(1), position_at({-777, 0}, 500, 50 * kPathTicksPerUnit, 2));
}

TEST_F(StreamBounds, CheckpointsAreComparedAlongTheWholeQueue) {
  ASSERT_EQ(start(), Verdict::kAccepted);
  std::vector<std::array<AxisState, 2>> at{{}, {}};  // before START and before the first segment
  for (int i = 0; i < 40; ++i) {
    ASSERT_EQ(move(100, i % 2 == 0 ? 5'000 : -5'000, i % 4 < 2 ? 300 : -300), Verdict::kAccepted);
    at.push_back(state);
  }
  ASSERT_EQ(end(), Verdict::kAccepted);
  for (std::size_t i = 0; i < at.size(); ++i)
    for (const int axis : {0, 1}) {
      const std::int64_t position = at[i][static_cast<std::size_t>(axis)].position;
      EXPECT_EQ(check(static_cast<std::uint8_t>(i), axis, position), Verdict::kAccepted) << i;
      EXPECT_EQ(check(static_cast<std::uint8_t>(i), axis, position + (std::int64_t{3} << 32)),
                Verdict::kCheckpoint)
          << i;
    }
  // Of a record that is executed it says nothing any more.
  ASSERT_TRUE(stream.advance_to(units(10 + 20 * 100)));
  EXPECT_EQ(check(20, 0, at[20][0].position + (std::int64_t{3} << 32)), Verdict::kStaleCheckpoint);
  EXPECT_EQ(check(21, 0, at[21][0].position), Verdict::kAccepted);
}

TEST_F(StreamBounds, ACheckpointIsAheadByAsMuchAsFitsAndNoMore) {
  EXPECT_EQ(check(SegmentStream::kMaxAhead, 0, 0), Verdict::kAccepted);
  EXPECT_EQ(check(SegmentStream::kMaxAhead + 1, 0, 0), Verdict::kStaleCheckpoint);
}

TEST_F(StreamBounds, ACheckpointAheadIsComparedAtItsRecordAndNeverAgain) {
  ASSERT_EQ(start(), Verdict::kAccepted);
  const AxisState there = advance(advance({}, 700, 50, 2), -700, 50, 2);
  ASSERT_EQ(check(3, 0, there.position), Verdict::kAccepted);
  ASSERT_EQ(move(50, 700), Verdict::kAccepted) << "not its record";
  ASSERT_EQ(move(50, -700), Verdict::kAccepted);
  // Once around all sequence numbers, and it is somewhere else by then.
  for (int i = 0; i < 130; ++i) {
    ASSERT_TRUE(stream.advance_to(units(10 + i * 50)));
    ASSERT_EQ(move(50, i % 2 == 0 ? 700 : -700), Verdict::kAccepted) << i;
  }
}

TEST_F(StreamBounds, BehindAClearTheLastRecordIsNoDuplicate) {
  ASSERT_EQ(start(), Verdict::kAccepted);
  for (int i = 0; i < 8; ++i) ASSERT_EQ(move(50, 0), Verdict::kAccepted);
  const std::uint64_t last = encode(Segment{.sequence = 8, .duration = 50, .acceleration = {0, 0}});
  EXPECT_EQ(stream.push(last, PathTime{0}), Verdict::kDuplicate);
  stream.clear(PathTime{0});
  EXPECT_EQ(stream.push(last, PathTime{0}), Verdict::kSequence);
}

TEST_F(StreamBounds, WhatCameEarlyWaitsForARecordThatIsTaken) {
  ASSERT_EQ(start(), Verdict::kAccepted);
  stream.set_following(0, false);
  const Segment early{.sequence = 2, .duration = 10, .acceleration = {0, 0}};
  ASSERT_EQ(stream.push(encode(early), PathTime{0}), Verdict::kEarly);
  EXPECT_EQ(stream.push(encode(Segment{.sequence = 1, .duration = 10, .acceleration = {5, 0}}), PathTime{0}),
            Verdict::kNotFollowing);
  EXPECT_TRUE(stream.waits_for_order());
  EXPECT_EQ(stream.next_sequence(), 1);
}

TEST_F(StreamBounds, AControlRecordThatIsNoneIsRefused) {
  ASSERT_EQ(start(), Verdict::kAccepted);
  const std::uint64_t end_of_one = encode(Segment{.sequence = 1, .control = SegmentControl::kEnd});
  for (int bit = 61; bit < 64; ++bit)
    EXPECT_EQ(stream.push(end_of_one ^ (std::uint64_t{1} << bit), PathTime{0}), Verdict::kUnknown) << bit;
  EXPECT_EQ(stream.size(), 1);
}

TEST_F(StreamBounds, AClearIsWherePathTimeIs) {
  ASSERT_EQ(start(), Verdict::kAccepted);
  ASSERT_EQ(move(100, 9'000, -4'000), Verdict::kAccepted);
  const std::int64_t ticks = 63 * kPathTicksPerUnit + 5;
  stream.clear(units(10) + PathTime{ticks});
  EXPECT_EQ(stream.position(0), position_at({}, 9'000, ticks, 2));
  EXPECT_EQ(stream.position(1), position_at({}, -4'000, ticks, 2));
  EXPECT_EQ(stream.velocity(0), 0);
  EXPECT_TRUE(stream.idle());
}

TEST_F(StreamBounds, SpeedIsThatOfTheInstant) {
  ASSERT_EQ(start(), Verdict::kAccepted);
  ASSERT_EQ(move(100, 900, -400), Verdict::kAccepted);
  const std::array<AxisState, 2> knot = state;
  ASSERT_EQ(move(100, -900, 400), Verdict::kAccepted);
  ASSERT_EQ(end(), Verdict::kAccepted);
  ASSERT_TRUE(stream.advance_to(units(9)));
  EXPECT_EQ(stream.velocity(0), 0);
  EXPECT_FALSE(stream.moving());
  for (std::int64_t ticks = 0; ticks < 200 * kPathTicksPerUnit; ticks += 777) {
    ASSERT_TRUE(stream.advance_to(units(10) + PathTime{ticks}));
    EXPECT_TRUE(stream.moving()) << ticks;
    const bool first = ticks < 100 * kPathTicksPerUnit;
    const std::int64_t into = first ? ticks : ticks - 100 * kPathTicksPerUnit;
    EXPECT_EQ(stream.velocity(0), velocity_at(first ? AxisState{} : knot[0], first ? 900 : -900, into, 2));
    EXPECT_EQ(stream.velocity(1), velocity_at(first ? AxisState{} : knot[1], first ? -400 : 400, into, 2));
  }
  ASSERT_TRUE(stream.advance_to(units(210) - PathTime{1}));
  EXPECT_FALSE(stream.idle());
  ASSERT_TRUE(stream.advance_to(units(210)));
  EXPECT_TRUE(stream.idle()) << "at the tick at which it ends";
  EXPECT_EQ(stream.velocity(0), 0);
  EXPECT_EQ(stream.consumed(), 4u);
}

TEST_F(StreamBounds, RunOutItStaysAtItsKnotThoughTimeGoesOn) {
  ASSERT_EQ(start(), Verdict::kAccepted);
  ASSERT_EQ(move(100, 900), Verdict::kAccepted);
  ASSERT_TRUE(stream.advance_to(units(110) - PathTime{1}));
  EXPECT_FALSE(stream.advance_to(units(110)));
  EXPECT_FALSE(stream.advance_to(units(500)));
  EXPECT_EQ(stream.position(0), state[0].position);
  EXPECT_EQ(stream.velocity(0), 0);
  EXPECT_EQ(push({.duration = 10, .acceleration = {0, 0}}), Verdict::kNotStarted);
}

}  // namespace
}  // namespace kinebus
