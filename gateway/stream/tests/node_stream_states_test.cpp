// A node's stream where something comes in between: a reset, a second run, a node that is behind, a status
// that tells little.
#include <gtest/gtest.h>

#include <random>

#include "gateway/stream/tests/record_runs.hpp"

namespace kinebus::testing_states {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::path_units;
using testing::push_run;
using testing::push_segments;

struct Sent {
  std::vector<Segment> records;
  std::vector<Checkpoint> checkpoints;
};
Sent send_all(NodeStream& stream, PathTime tau, BusTime now = BusTime{0}) {
  Sent sent;
  while (const auto frame = stream.next_frame(now, tau))
    if ((frame->id & 0x780u) == 0x500u)
      sent.checkpoints.push_back(decode_checkpoint(get_u64_le(frame->data)));
    else
      sent.records.push_back(*decode_segment(get_u64_le(frame->data)));
  return sent;
}

StreamStatus status(std::uint64_t next, std::uint8_t free_records, std::int64_t path_units = 0) {
  return {.next_sequence = static_cast<std::uint8_t>(next % kSequenceModulus),
          .free_records = free_records,
          .path_units = static_cast<std::uint32_t>(path_units)};
}

TEST(NodeStream, AResetForgetsTheRunThatWasUnderWay) {
  NodeStream stream(1);
  stream.reset({}, 0, 120);
  stream.push_start();
  push_segments(stream, 3, 100);
  stream.release(1000);
  ASSERT_TRUE(stream.next_frame({}, path_units(0)));
  ASSERT_EQ(stream.next_frame({}, path_units(0))->id, 0x501u) << "one of two checkpoints";
  push_segments(stream, 1, 100, 300);
  NodeStream opened(1);
  opened.reset({}, 0, 120);
  opened.push_start();
  push_segments(opened, 3, 100);
  for (NodeStream* s : {&stream, &opened}) {
    s->reset({AxisState{to_fixed(12), 99}, AxisState{to_fixed(-3), -99}}, 77, 120);
    EXPECT_EQ(s->made_until_units(), 0);
    EXPECT_EQ(s->unsent(), 0u);
    EXPECT_EQ(s->final_state()[0], (AxisState{to_fixed(12), 0}));
    EXPECT_EQ(s->final_state()[1], (AxisState{to_fixed(-3), 0}));
    EXPECT_EQ(*s->state_at(path_units(123)), s->final_state()) << "no records: it stands there";
    EXPECT_FALSE(s->next_frame({}, path_units(0)));
    push_run(*s, 2, 50);
    s->release(10);
    const Sent sent = send_all(*s, path_units(0));
    ASSERT_EQ(sent.records.size(), 4u);
    EXPECT_EQ(sent.records[0].sequence, 77);
    EXPECT_EQ(sent.records[0].start_units, 10);
    ASSERT_EQ(sent.checkpoints.size(), 2u) << "both axes anew";
    EXPECT_EQ(sent.checkpoints[0].position, to_fixed(12));
    EXPECT_EQ(s->made_until_units(), 110);
  }
}

TEST(NodeStream, CheckpointsComeEvery64RecordsOfOneAxisInTurn) {
  NodeStream stream(1, {.horizon = SegmentUnits{1'000'000}, .queue_records = 1000});
  stream.reset({}, 0, 255);
  push_run(stream, 230, 20);
  stream.release(0);
  const Sent sent = send_all(stream, path_units(0));
  std::vector<std::pair<int, int>> expected{{1, 0}, {1, 1}, {65, 0}, {129 % 128, 1}, {193 % 128, 0}};
  ASSERT_EQ(sent.checkpoints.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(sent.checkpoints[k].sequence, expected[k].first) << k;
    EXPECT_EQ(sent.checkpoints[k].axis, expected[k].second) << k;
  }
  EXPECT_EQ(stream.counters().records, 232u);
  EXPECT_EQ(stream.counters().checkpoints, 5u);
  EXPECT_EQ(stream.counters().statuses, 0u);
}

TEST(NodeStream, ASecondRunWaitsForItsReleaseAndChangesNothingOfTheFirst) {
  NodeStream stream(1);
  stream.reset({}, 0, 120);
  push_run(stream, 4, 100);
  stream.release(1000);
  EXPECT_EQ(send_all(stream, path_units(0)).records.size(), 6u);
  const auto end = stream.final_state();
  stream.push_start();
  push_segments(stream, 2, 100);
  EXPECT_TRUE(send_all(stream, path_units(0)).records.empty());
  // A status while it is open; the times of its records are none yet.
  ASSERT_TRUE(stream.on_status({}, status(6, 120, 1250), path_units(1250)));
  EXPECT_EQ(*stream.state_at(path_units(5000)), end);
  EXPECT_EQ(stream.line_at(path_units(1250)), 3u);
  stream.release(9000);
  push_segments(stream, 2, 100, 200);
  stream.push_end();
  EXPECT_EQ(stream.made_until_units(), 9400);
  EXPECT_EQ(stream.unsent_begins_units(0), 9000);
  EXPECT_EQ(stream.unsent_begins_units(2), 9100);
  EXPECT_EQ(stream.unsent_begins_units(4), 9300) << "pushed behind the release";
  EXPECT_EQ(stream.unsent_begins_units(100), 9400);
  const Sent sent = send_all(stream, path_units(0));
  ASSERT_EQ(sent.records.size(), 6u);
  EXPECT_EQ(sent.records[0].start_units, 9000);
  EXPECT_EQ(*stream.state_at(path_units(8000)), end);
  EXPECT_EQ(stream.line_at(path_units(9301)), 2u);
}

TEST(NodeStream, SilenceCountsFromTheFirstRecordThatIsNotTaken) {
  NodeStream stream(1);
  stream.reset({}, 0, 120);
  EXPECT_TRUE(stream.on_status(seconds{9}, status(0, 120), path_units(0))) << "nothing was sent";
  push_run(stream, 20, 1000);
  stream.release(0);
  // One every 50 ms, from 10 s on; nothing is taken.
  std::optional<BusTime> silent;
  for (BusTime now = seconds{10}; now < seconds{11} && !silent; now += milliseconds{50}) {
    (void)stream.next_frame(now, path_units(0));
    if (const auto ok = stream.on_status(now, status(0, 120), path_units(0)); !ok) {
      EXPECT_EQ(ok.error().kind, StreamError::Kind::kSilent);
      EXPECT_EQ(ok.error().amount, 400);
      EXPECT_EQ(ok.error().node_id, 1);
      silent = now;
    }
  }
  EXPECT_EQ(silent, BusTime{milliseconds{10'400}});
  // Some are taken: from then on anew.
  ASSERT_TRUE(stream.on_status(milliseconds{10'410}, status(2, 118), path_units(0)));
  EXPECT_TRUE(stream.on_status(milliseconds{10'760}, status(2, 118), path_units(0)));
  EXPECT_FALSE(stream.on_status(milliseconds{10'761}, status(2, 118), path_units(0)));
}

TEST(NodeStream, SaysWhichRecordAndWhichLine) {
  NodeStream stream(4);
  stream.reset({}, 0, 120);
  push_run(stream, 10, 100);
  stream.release(0);
  (void)send_all(stream, path_units(0));
  for (const auto flag :
       {StreamStatus::kSequenceError, StreamStatus::kCheckpointError, StreamStatus::kUnderrun}) {
    StreamStatus s = status(5, 115, 320);
    s.flags = flag;
    const auto wrong = stream.on_status({}, s, path_units(320));
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().line, 4u);
    EXPECT_EQ(wrong.error().node_id, 4);
    EXPECT_EQ(wrong.error().amount, flag == StreamStatus::kSequenceError ? 5 : 0);
    ASSERT_TRUE(stream.last_status());
    EXPECT_EQ(stream.last_status()->flags, flag);
  }
  const auto unknown = stream.on_status({}, status(20, 100), path_units(320));
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().amount, 20);
  EXPECT_EQ(stream.counters().statuses, 4u);
}

TEST(NodeStream, AStatusIsOldUpToSevenRecordsBack) {
  for (int behind = 1; behind <= 9; ++behind) {
    NodeStream stream(1);
    stream.reset({}, 0, 120);
    push_run(stream, 40, 10);
    stream.release(0);
    (void)send_all(stream, path_units(0));
    ASSERT_TRUE(stream.on_status({}, status(30, 90), path_units(0)));
    // Farther back it would be one ahead that takes more than a queue holds, of records that nobody sent.
    EXPECT_EQ(
        stream.on_status({}, status(30 - static_cast<std::uint64_t>(behind), 90), path_units(0)).has_value(),
        behind <= NodeStream::kMaxOvertaken)
        << behind;
  }
  // Nothing lies before the first record.
  NodeStream fresh(1);
  fresh.reset({}, 2, 120);
  EXPECT_TRUE(fresh.on_status({}, status(0, 120), path_units(0))) << "2 behind";
  EXPECT_EQ(fresh.on_status({}, status(127, 120), path_units(0)).error().kind,
            StreamError::Kind::kUnknownRecord);
}

TEST(NodeStream, KeepsWhatANodeThatIsBehindHasNotPassed) {
  for (const std::int64_t start : {std::int64_t{1000}, (std::int64_t{1} << 32) - 1500}) {
    NodeStream stream(1);
    stream.reset({}, 0, 120);
    push_run(stream, 40, 100);
    stream.release(start);
    (void)send_all(stream, path_units(start));
    ASSERT_TRUE(stream.all_sent());
    ASSERT_TRUE(stream.on_status({}, status(20, 100, start + 1000), path_units(start + 2000)));
    EXPECT_TRUE(stream.state_at(path_units(start + 1001)));
    EXPECT_FALSE(stream.state_at(path_units(start + 899)));
    EXPECT_EQ(stream.accepted_state(), *stream.state_at(path_units(start + 1900)));
    // And so where the node is ahead, by its clock.
    ASSERT_TRUE(stream.on_status({}, status(30, 100, start + 2500), path_units(start + 2000)));
    EXPECT_TRUE(stream.state_at(path_units(start + 2001)));
    EXPECT_FALSE(stream.state_at(path_units(start + 1800)));
    EXPECT_EQ(stream.accepted_until_units(), start + 2900);
    // No more than was accepted.
    ASSERT_TRUE(stream.on_status({}, status(30, 100, start + 3900), path_units(start + 3900)));
    EXPECT_TRUE(stream.state_at(path_units(start + 2900)));
  }
}

TEST(NodeStream, CountsWhatIsNotSentUntilAnyTime) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    std::mt19937 random(seed);
    NodeStream stream(1);
    stream.reset({}, 0, static_cast<std::uint8_t>(random() % 100));
    stream.push_start();
    FittedSegment s;
    for (auto k = random() % 300; k > 0; --k) {
      s.duration = static_cast<std::int32_t>(1 + random() % 300);
      stream.push(s);
      s.start_units += s.duration;
    }
    stream.push_end();
    stream.release(500);
    (void)send_all(stream, path_units(400));
    for (int look = 0; look < 100; ++look) {
      const std::int64_t until = static_cast<std::int64_t>(random() % 50'000);
      std::uint64_t expected = 0;
      while (expected < stream.unsent() && stream.unsent_begins_units(expected) <= until) ++expected;
      EXPECT_EQ(stream.unsent_until(until), expected) << "seed " << seed;
      EXPECT_EQ(stream.unsent_until(until, random() % (expected + 1)), expected) << "seed " << seed;
      if (stream.unsent() > 0) {
        const std::int64_t edge = stream.unsent_begins_units(random() % stream.unsent());
        const auto with = stream.unsent_until(edge), without = stream.unsent_until(edge - 1);
        EXPECT_GT(with, without) << "seed " << seed;
        EXPECT_EQ(stream.unsent_until(edge, without), with) << "seed " << seed;
      }
    }
  }
}

TEST(NodeStream, WhereTheAxesStandIsKnownWhileTheNextRunIsMade) {
  NodeStream stream(1);
  stream.reset({}, 0, 120);
  push_run(stream, 4, 100);
  stream.release(1000);
  (void)send_all(stream, path_units(1000));
  const auto rest = stream.final_state();
  ASSERT_TRUE(stream.on_status({}, status(6, 120, 1200), path_units(1200)));
  stream.push_start();
  push_segments(stream, 2, 100);
  for (const std::int64_t now : {1399, 1400, 1500, 9000}) {
    ASSERT_TRUE(stream.on_status({}, status(6, 120, now), path_units(now)));
    ASSERT_TRUE(stream.state_at(path_units(now))) << now;
    if (now < 1400) continue;
    EXPECT_EQ(*stream.state_at(path_units(now)), rest) << now;
  }
}

/// What the node did before is not known here.
TEST(NodeStream, ACheckOfWhatWasBeforeAResetIsNoneOfItsRecords) {
  NodeStream stream(1);
  stream.reset({AxisState{to_fixed(12), 0}, AxisState{}}, 7, 120);
  for (const std::uint8_t check : {std::uint8_t{0x00}, std::uint8_t{0x5A}, std::uint8_t{0xFF}}) {
    StreamStatus told = status(7, 120, 5000);
    told.tail_check = check;
    EXPECT_TRUE(stream.on_status({}, told, path_units(5000)));
  }
}

}  // namespace
}  // namespace kinebus::testing_states
