// The check of the queue's tail: what a record with a wrong bit leads to, and how often 8 bits miss it.

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "node_firmware/core/segment_stream.hpp"

namespace kinebus {
namespace {

using Verdict = SegmentStream::Verdict;

constexpr int kSeeds = 40, kRecords = 70;  // a queue's at most, with the last run's

class Records {
 public:
  explicit Records(std::uint32_t seed) : random_(seed), sequence_(static_cast<std::uint8_t>(seed % 128)) {
    while (static_cast<int>(raw_.size()) < kRecords) add_run();
  }
  const std::vector<std::uint64_t>& raw() const { return raw_; }

 private:
  int draw(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  void add(Segment segment) {
    segment.sequence = sequence_;
    sequence_ = static_cast<std::uint8_t>((sequence_ + 1) % kSequenceModulus);
    raw_.push_back(encode(segment));
    units_ += segment.duration;
  }
  void add_motion(int units, int a, int b) {
    add({.duration = static_cast<std::uint16_t>(units), .acceleration = {a, b}});
  }
  /// Lines as a planner makes them: speeding up, cruising, braking; both axes alike, one alone, or neither.
  void add_run() {
    add({.control = SegmentControl::kStart, .start_units = units_ += draw(10, 5000)});
    for (int lines = draw(1, 12); lines > 0; --lines) {
      const int ramp = draw(1, 3000), cruise = draw(1, kMaxSegmentUnits);
      const int a = draw(-20'000, 20'000);
      const int b = std::array{a, -a, 0, draw(-20'000, 20'000)}[static_cast<std::size_t>(draw(0, 3))];
      add_motion(ramp, a, b);
      if (draw(0, 2) != 0) add_motion(cruise, 0, 0);
      add_motion(ramp, -a, -b);
      if (draw(0, 3) == 0) add_motion(draw(1, kMaxSegmentUnits), 0, 0);  // a dwell
    }
    add({.control = SegmentControl::kEnd});
  }

  std::mt19937 random_;
  std::uint8_t sequence_;
  std::int64_t units_ = 100;
  std::vector<std::uint64_t> raw_;
};

/// A node that expects the first of these records.
SegmentStream node_before(const std::vector<std::uint64_t>& raw) {
  SegmentStream stream;
  stream.set_following(0, true);
  stream.set_following(1, true);
  // Sequence numbers begin at 0: empty runs lead to the first one, which is even.
  for (std::uint8_t next = 0; next != (raw[0] & 0x7F); next = static_cast<std::uint8_t>(next + 2)) {
    const Segment start{.sequence = next, .control = SegmentControl::kStart, .start_units = 1};
    const Segment end{.sequence = static_cast<std::uint8_t>(next + 1), .control = SegmentControl::kEnd};
    for (const Segment& filler : {start, end})
      EXPECT_EQ(stream.push(encode(filler), PathTime{0}), Verdict::kAccepted);
    stream.advance_to(PathTime{2 * kPathTicksPerUnit});
  }
  return stream;
}

bool same_tail(const SegmentStream& a, const SegmentStream& b) {
  return a.tail_state(0) == b.tail_state(0) && a.tail_state(1) == b.tail_state(1) &&
         a.horizon() == b.horizon() && a.open() == b.open();
}

TEST(TailCheck, EveryWrongBitOfARecordIsRefusedOrChangesWhatIsChecked) {
  constexpr std::size_t kNextLook = 8;  // records between two statuses
  std::size_t taken = 0, refused = 0, missed = 0, missed_twice = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const std::vector<std::uint64_t> raw = Records(2 * seed).raw();
    std::vector<SegmentStream> good{node_before(raw)};
    for (const std::uint64_t record : raw) {
      SegmentStream next = good.back();
      ASSERT_EQ(next.push(record, PathTime{0}), Verdict::kAccepted) << "seed " << seed;
      good.push_back(next);
    }
    for (std::size_t i = 0; i < raw.size(); ++i)
      for (int bit = 0; bit < 64; ++bit) {
        SegmentStream wrong = good[i];
        if (wrong.push(raw[i] ^ std::uint64_t{1} << bit, PathTime{0}) != Verdict::kAccepted) {
          ++refused;
          continue;
        }
        ++taken;
        ASSERT_FALSE(same_tail(wrong, good[i + 1])) << "seed " << seed << ", record " << i << ", bit " << bit;
        if (wrong.tail_check(0) != good[i + 1].tail_check(0)) continue;
        ++missed;
        bool seen = i + 1 == raw.size();  // nothing comes that could be looked at
        for (std::size_t n = i + 1; n < raw.size() && !seen; ++n) {
          seen = wrong.push(raw[n], PathTime{0}) != Verdict::kAccepted;
          if (!seen && (n - i == kNextLook || n + 1 == raw.size()))
            seen = wrong.tail_check(0) != good[n + 1].tail_check(0);
          if (n - i == kNextLook) break;
        }
        if (!seen) ++missed_twice;
      }
  }
  RecordProperty("taken", static_cast<int>(taken));
  RecordProperty("missed", static_cast<int>(missed));
  RecordProperty("missed_twice", static_cast<int>(missed_twice));
  EXPECT_GT(taken, 100'000u) << refused << " refused";
  EXPECT_LT(missed, taken / 200) << "of " << taken << ", one in 256 is what 8 bits can do";
  EXPECT_LT(missed_twice, taken / 10'000) << "of " << taken << ", " << missed << " missed once";
}

// What is wrong by the same for long, as a position after a wrong duration is, is looked at anew each time.
TEST(TailCheck, AStateThatIsWrongByTheSameIsNotMissedAgainAndAgain) {
  std::mt19937_64 random(7);
  const auto draw = [&](int bits) { return static_cast<std::int64_t>(random()) >> (64 - bits); };
  std::size_t looks = 0, missed = 0, missed_four_times = 0;
  for (int n = 0; n < 20'000; ++n) {
    std::array<AxisState, kAxesPerNode> good{AxisState{draw(50), 0}, AxisState{draw(50), 0}}, wrong = good;
    const std::int64_t by = std::int64_t{1} << random() % 40;
    for (AxisState& axis : wrong) axis.position += by;
    int misses = 0;
    for (std::uint8_t look = 0; look < 4; ++look) {
      const auto sequence = static_cast<std::uint8_t>((static_cast<std::uint64_t>(n) + look * 5u) % 128);
      const std::int64_t units = 1000 + 5000 * look;
      ++looks;
      misses += tail_check(sequence, good, units, units) == tail_check(sequence, wrong, units, units) ? 1 : 0;
    }
    missed += static_cast<std::size_t>(misses);
    missed_four_times += misses == 4 ? 1 : 0;
  }
  EXPECT_LT(missed, looks / 128) << "of " << looks;
  EXPECT_EQ(missed_four_times, 0u);
}

// A path time that is wrong by what a status with a check does not tell.
TEST(TailCheck, HoldsWhatAStatusHasNoRoomFor) {
  std::size_t missed = 0;
  for (int bit = 24; bit < 42; ++bit)
    for (std::uint8_t sequence = 0; sequence < 128; ++sequence) {
      const std::array<AxisState, kAxesPerNode> axes{};
      const std::int64_t wrong = 5000 + (std::int64_t{1} << bit);
      missed += tail_check(sequence, axes, 4000, 5000) == tail_check(sequence, axes, 4000, wrong) ? 1 : 0;
    }
  EXPECT_LT(missed, 18 * 128 / 128);
}

}  // namespace
}  // namespace kinebus
