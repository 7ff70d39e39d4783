#include "gateway/stream/node_stream.hpp"

#include <gtest/gtest.h>

#include <random>

#include "gateway/stream/tests/model_node.hpp"
#include "gateway/stream/tests/record_runs.hpp"

namespace kinebus::testing {
namespace {

using std::chrono::milliseconds;

StreamStatus status(std::uint8_t next, std::uint8_t free_records) {
  return {.next_sequence = next, .free_records = free_records};
}

TEST(NodeStream, SendsStartThenACheckpointOfEachAxisThenMotion) {
  NodeStream stream(2);
  stream.reset({AxisState{to_fixed(1234.5), 0}, AxisState{to_fixed(-7), 0}}, 120, 120);
  push_run(stream, 4, 100);
  EXPECT_FALSE(stream.next_frame({}, path_units(0))) << "before release";
  stream.release(5000);
  const auto start = stream.next_frame({}, path_units(0));
  ASSERT_TRUE(start);
  EXPECT_EQ(start->id, 0x402u);
  EXPECT_EQ(decode_segment(get_u64_le(start->data)),
            (Segment{.sequence = 120, .control = SegmentControl::kStart, .start_units = 5000}));
  for (std::uint8_t axis = 0; axis < 2; ++axis) {
    const auto frame = stream.next_frame({}, path_units(0));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->id, 0x502u);
    const Checkpoint c = decode_checkpoint(get_u64_le(frame->data));
    EXPECT_EQ(c.sequence, 121);
    EXPECT_EQ(c.axis, axis);
    EXPECT_EQ(c.position, axis == 0 ? to_fixed(1234.5) : to_fixed(-7));
  }
  const auto segment = decode_segment(get_u64_le(stream.next_frame({}, path_units(0))->data));
  EXPECT_EQ(segment->sequence, 121);
  EXPECT_EQ(segment->duration, 100);
}

TEST(NodeStream, KeepsTheHorizon) {
  NodeStream stream(1);
  stream.reset({}, 0, 120);
  push_run(stream, 60, 1000);
  stream.release(10'000);
  while (stream.next_frame({}, path_units(0))) {
  }
  EXPECT_EQ(stream.sent_until_units(), 26'000);  // the first record that begins beyond 25,000
  while (stream.next_frame({}, path_units(3'000))) {
  }
  EXPECT_EQ(stream.sent_until_units(), 29'000);
}

TEST(NodeStream, NeverSendsMoreThanANodeWithAMindOfItsOwnHasRoomFor) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    std::mt19937 random(seed);
    NodeStream stream(1);
    ModelNode node(1);
    node.capacity = 1 + random() % 120;
    stream.reset({}, 0, node.status().free_records);
    std::int64_t now = 0;
    int runs = 0;
    for (int step = 0; step < 200'000 && !(runs == 5 && stream.all_accepted()); ++step) {
      if (stream.all_sent() && node.ended == (runs > 0) && stream.all_accepted() && runs < 5) {
        now = std::max(now, stream.made_until_units()) + 5;
        push_run(stream, 2 * static_cast<int>(1 + random() % 150),
                 static_cast<std::int32_t>(1 + random() % 200));
        stream.release(now + 10);
        ++runs;
      }
      for (auto k = random() % 40; k > 0; --k)
        if (const auto frame = stream.next_frame({}, path_units(now))) node.on_frame(*frame);
      // The node executes what it has, but never past it, and reports now and then.
      now = std::max(now, std::min(now + static_cast<std::int64_t>(random() % 600), node.until_units()));
      node.advance_to(path_units(now));
      if (random() % 3 == 0) {
        ASSERT_TRUE(stream.on_status({}, node.status(), path_units(now))) << "seed " << seed;
      }
    }
    EXPECT_EQ(node.complaint, "") << "seed " << seed;
    EXPECT_EQ(runs, 5) << "seed " << seed;
    EXPECT_TRUE(stream.all_sent()) << "seed " << seed;
    EXPECT_EQ(node.tail(), stream.final_state()) << "seed " << seed;
  }
}

TEST(NodeStream, CheckpointsComeRoundOnBothAxes) {
  NodeStream stream(1, {.horizon = SegmentUnits{1'000'000}, .checkpoint_interval = 10});
  ModelNode node(1);
  stream.reset({}, 0, 120);
  push_run(stream, 300, 50);
  stream.release(0);
  for (std::int64_t now = 0; now < 16'000; now += 500) {
    node.advance_to(path_units(now));
    ASSERT_TRUE(stream.on_status({}, node.status(), path_units(now)));
    while (const auto frame = stream.next_frame({}, path_units(now))) node.on_frame(*frame);
  }
  EXPECT_EQ(node.records(), 302u);
  EXPECT_EQ(node.complaint, "");
  EXPECT_GE(node.checkpoints, 30u);
}

TEST(NodeStream, AStatusThatWasOvertakenSaysNothing) {
  NodeStream stream(1);
  stream.reset({}, 0, 120);
  push_run(stream, 10, 100);
  stream.release(0);
  while (stream.next_frame({}, path_units(0))) {
  }
  ASSERT_TRUE(stream.on_status({}, status(8, 112), path_units(0)));
  ASSERT_TRUE(stream.on_status({}, status(5, 115), path_units(0)));
  ASSERT_TRUE(stream.on_status({}, status(12, 108), path_units(0)));
  EXPECT_TRUE(stream.all_sent());
  // One that comes again and again, while what was sent is not taken, is a node that takes nothing.
  push_run(stream, 10, 100);
  stream.release(2000);
  while (stream.next_frame({}, path_units(0))) {
  }
  const auto late = stream.on_status(milliseconds{400}, status(9, 111), path_units(0));
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().kind, StreamError::Kind::kSilent);
}

TEST(NodeStream, ReportsARecordThatTheNodeCannotKnow) {
  NodeStream stream(3);
  stream.reset({}, 0, 120);
  const auto ok = stream.on_status({}, status(5, 120), path_units(0));
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().kind, StreamError::Kind::kUnknownRecord);
  EXPECT_EQ(ok.error().node_id, 3);
}

TEST(NodeStream, ReportsRecordsThatWereSentAndNeverAccepted) {
  NodeStream stream(1);
  stream.reset({}, 0, 120);
  push_run(stream, 10, 100);
  stream.release(0);
  while (stream.next_frame(milliseconds{100}, path_units(0))) {
  }
  EXPECT_TRUE(stream.on_status(milliseconds{200}, status(3, 117), path_units(0)));
  EXPECT_TRUE(stream.on_status(milliseconds{400}, status(3, 117), path_units(0)));
  const auto ok = stream.on_status(milliseconds{600}, status(3, 117), path_units(0));
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().kind, StreamError::Kind::kSilent);
}

TEST(NodeStream, PassesOnWhatTheNodeFound) {
  NodeStream stream(1);
  stream.reset({}, 0, 120);
  StreamStatus s = status(0, 120);
  s.flags = StreamStatus::kSequenceError;
  EXPECT_EQ(stream.on_status({}, s, path_units(0)).error().kind, StreamError::Kind::kSequence);
  s.flags = StreamStatus::kCheckpointError;
  EXPECT_EQ(stream.on_status({}, s, path_units(0)).error().kind, StreamError::Kind::kCheckpoint);
  s.flags = StreamStatus::kUnderrun;
  EXPECT_EQ(stream.on_status({}, s, path_units(0)).error().kind, StreamError::Kind::kUnderrun);
}

enum class Seen { kInTime, kLate, kRefused };

/// One record of a run reaches the node with a wrong bit, and statuses come 120 ms apart.
Seen status_sees(int record, int bit) {
  constexpr std::int64_t kBegin = 10'000, kDuration = 1'250, kPeriod = 7'500, kStop = 4'063;  // 65 ms
  NodeStream stream(1);
  ModelNode node(1);
  stream.reset({}, 0, 120);
  push_run(stream, 100, kDuration);
  stream.release(kBegin);
  const std::int64_t begins = kBegin + std::max(0, record - 1) * kDuration;
  std::int64_t now = kBegin - 3'000;
  for (int statuses = 0, sent = 0; statuses < 6; ++statuses) {
    // Path time runs when the first records are confirmed.
    if (statuses >= 2) now += kPeriod;
    node.advance_to(path_units(now));
    const auto ok = stream.on_status({}, node.status(), path_units(now));
    if (!node.complaint.empty()) return Seen::kRefused;
    if (!ok) {
      EXPECT_EQ(ok.error().kind, StreamError::Kind::kTakenOtherwise);
      EXPECT_EQ(ok.error().node_id, 1);
      return statuses == 1 || now + kStop <= begins ? Seen::kInTime : Seen::kLate;
    }
    while (auto frame = stream.next_frame({}, path_units(now))) {
      if (frame->id == 0x401 && sent++ == record)
        frame->data[static_cast<std::size_t>(bit) / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
      node.on_frame(*frame);
    }
  }
  return Seen::kLate;
}

TEST(NodeStream, SeesARecordWithAWrongBitBeforeItIsExecuted) {
  int in_time = 0, late = 0, refused = 0;
  for (int record = 0; record < 32; ++record)
    for (int bit = 0; bit < 64; ++bit) {
      const Seen seen = status_sees(record, bit);
      ++(seen == Seen::kInTime ? in_time : seen == Seen::kLate ? late : refused);
    }
  EXPECT_GT(in_time, 1'500) << refused << " were refused";
  EXPECT_LE(late, 4) << "one in 256 is missed at first, and the second look is late for the first of them";
}

TEST(NodeStream, ANodeThatTellsNoCheckIsBelieved) {
  NodeStream stream(1);
  ModelNode node(1);
  stream.reset({}, 0, 120);
  push_run(stream, 10, 100);
  stream.release(0);
  while (auto frame = stream.next_frame({}, path_units(0))) {
    if (frame->id == 0x401 && (frame->data[0] & 0x7F) == 5) frame->data[3] ^= 1;
    node.on_frame(*frame);
  }
  StreamStatus status = node.status();
  EXPECT_FALSE(stream.on_status({}, status, path_units(0)));
  status.tail_check.reset();
  EXPECT_TRUE(stream.on_status({}, status, path_units(0)));
}

TEST(NodeStream, KnowsTheExactStateAndLineAtAnyPathTimeNotYetPassed) {
  NodeStream stream(1);
  ModelNode node(1);
  stream.reset({}, 0, 120);
  push_run(stream, 40, 300);
  stream.release(1000);
  while (const auto frame = stream.next_frame({}, path_units(0))) node.on_frame(*frame);
  for (std::int64_t tau = 0; tau < 13'500 * kPathTicksPerUnit; tau += 77'777) {
    const auto states = stream.state_at(PathTime{tau});
    ASSERT_TRUE(states) << tau;
    for (std::size_t axis = 0; axis < 2; ++axis)
      EXPECT_EQ((*states)[axis].position, node.position(PathTime{tau}, axis)) << tau;
  }
  EXPECT_EQ(stream.line_at(path_units(1000)), 1u);
  EXPECT_EQ(stream.line_at(path_units(1300)), 2u);
  node.advance_to(path_units(4'100));
  ASSERT_TRUE(stream.on_status({}, node.status(), path_units(4'100)));
  EXPECT_FALSE(stream.state_at(path_units(3'000))) << "passed by both";
  EXPECT_TRUE(stream.state_at(path_units(4'100)));
  EXPECT_EQ(stream.accepted_state(), stream.final_state());
}

}  // namespace
}  // namespace kinebus::testing
