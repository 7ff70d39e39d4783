#include "gateway/stream/bus_budget.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace kinebus::testing {
namespace {

PathTime units(std::int64_t n) {
  return PathTime{n * kPathTicksPerUnit};
}

/// A stream whose node has room for nothing more: all records wait, each of `duration` units.
NodeStream waiting(int count, std::int32_t duration, std::int64_t start = 0) {
  NodeStream stream(1);
  stream.reset({}, 0, 0);
  stream.push_start();
  FittedSegment s;
  s.duration = duration;
  for (int k = 0; k < count; ++k) {
    stream.push(s);
    s.start_units += duration;
  }
  stream.push_end();
  stream.release(start);
  return stream;
}

double rate(const std::vector<NodeStream>& streams, std::int64_t now, bool complete = true) {
  std::vector<const NodeStream*> nodes;
  for (const NodeStream& s : streams) nodes.push_back(&s);
  return BusBudget().allowed_rate(nodes, units(now), complete);
}

TEST(BusBudget, AllowsFullRateWhenRecordsAreSparse) {
  // 3 nodes, a record each 20 ms, the first of them due in 320 ms.
  const std::vector<NodeStream> streams(3, waiting(100, 1250));
  EXPECT_EQ(rate(streams, -20'000), 1);
}

TEST(BusBudget, SlowsThePathToWhatTheBusCarries) {
  // 3 nodes, a record each 0.4 ms: 7500 records a second where 0.57 Mbit/s carry 4160.
  const std::vector<NodeStream> streams(3, waiting(1000, 25));
  const double r = rate(streams, -20'000);
  EXPECT_LT(r, 0.9);
  EXPECT_GT(r, 0.3);
}

TEST(BusBudget, KeepsTimeToLookAndToStopInAFullQueue) {
  // One node, 0.5 ms a record: 120 records are 60 ms. The bus alone would carry them, but not in time for a
  // second status and a stop: 28 ms of 55 r + 50 r^2.
  const std::vector<NodeStream> streams(1, waiting(600, 31));
  const double r = rate(streams, -30'000);
  EXPECT_NEAR(r, 0.378, 0.01);
}

TEST(BusBudget, AsksForAStopWhenTheRunIsNotMadeInTime) {
  const std::vector<NodeStream> streams(1, waiting(10, 100));
  EXPECT_EQ(rate(streams, 1'000, false), 0);
  EXPECT_LT(rate(streams, -3'000, false), 0.6);
}

/// A full queue is looked at after 64 of its 120 records, in 55 ms, and a stop takes half of 100 ms at full
/// rate, at others as the rate's square: the greatest rate at which what is left of the queue does for both.
double rate_of_full_queue(double covered_s) {
  double low = 0, high = 100;
  for (int i = 0; i < 60; ++i) {
    const double rate = (low + high) / 2;
    (rate * 0.055 + rate * rate * 0.050 <= covered_s * 56 / 120 ? low : high) = rate;
  }
  return low;
}

/// Every record that waits has its deadline: what the bus carries until it begins, less the reserve.
double least_of_deadlines(const std::vector<NodeStream>& streams, std::int64_t now) {
  const BusBudget::Options o;
  const double reserve_s = static_cast<double>(o.reserve.count()) * kSecondsPerUnit;
  const double record_s = o.bits_per_record / (o.bits_per_second * (o.share - o.overhead));
  std::vector<std::int64_t> begins;
  double rate = 1;
  for (const NodeStream& s : streams) {
    for (std::uint64_t n = 0; n < s.unsent(); ++n) begins.push_back(s.unsent_begins_units(n));
    for (std::uint64_t n = 0; n + 120 < s.unsent(); n += 16) {
      const std::int64_t from = s.unsent_begins_units(n);
      const auto covered = static_cast<double>(s.unsent_begins_units(n + 120) - from) * kSecondsPerUnit;
      if (from <= now + 62'520) rate = std::min(rate, std::max(rate_of_full_queue(covered), o.lowest_rate));
    }
  }
  std::sort(begins.begin(), begins.end());
  for (std::size_t k = 0; k < begins.size() && begins[k] <= now + 62'520; ++k) {
    const double x = static_cast<double>(std::max<std::int64_t>(begins[k] - now, 0)) * kSecondsPerUnit;
    rate = std::min(rate, x / (static_cast<double>(k + 1) * record_s + reserve_s));
  }
  return rate;
}

TEST(BusBudget, IsWhatTheTightestDeadlineAllows) {
  int slowed = 0;
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    std::mt19937 random(seed);
    std::vector<NodeStream> streams;
    const auto nodes = 1 + random() % 4;
    for (std::uint32_t n = 0; n < nodes; ++n) {
      NodeStream stream(1);
      stream.reset({}, 0, 0);
      stream.push_start();
      FittedSegment s;
      // Sparse and dense stretches in turn.
      for (int k = 0; k < 900 && s.start_units < 80'000; ++k) {
        const auto mean = (k / 150 + static_cast<int>(seed + n)) % 3 == 0 ? 15u : 300u;
        s.duration = static_cast<std::int32_t>(1 + random() % mean);
        stream.push(s);
        s.start_units += s.duration;
      }
      stream.push_end();
      stream.release(0);
      streams.push_back(std::move(stream));
    }
    for (const std::int64_t now : {-60'000, -20'000, -9'000, -3'000}) {
      const double is = rate(streams, now), exact = least_of_deadlines(streams, now);
      // Deadlines are looked at every 25 ms.
      EXPECT_GE(is, exact - 1e-9) << "seed " << seed << " at " << now;
      EXPECT_LE(is, 1.3 * exact) << "seed " << seed << " at " << now;
      slowed += exact < 0.9 && exact > 0.1;
    }
  }
  EXPECT_GT(slowed, 300);
}

TEST(BusBudget, WhatIsMadeMustReachOverTheReserve) {
  NodeStream stream = waiting(10, 1000);
  ASSERT_TRUE(stream.on_status({}, {.free_records = 120}, units(-20'000)));
  while (stream.next_frame({}, units(0))) {
  }
  ASSERT_EQ(stream.unsent(), 0u);
  std::vector<NodeStream> streams;
  streams.push_back(std::move(stream));
  // Made until 10,000; the reserve is 7,500 units.
  EXPECT_NEAR(rate(streams, 6'250, false), 0.5, 1e-9);
  EXPECT_EQ(rate(streams, 6'250, true), 1);
  EXPECT_EQ(rate(streams, 1'000, false), 1);
}

TEST(BusBudget, AFewRecordsThatAreDueSoonSlowItAsWell) {
  for (const std::int32_t duration : {5, 40, 1000}) {
    for (const std::int64_t now : {-6'000, -1'500, -200}) {
      const std::vector<NodeStream> streams(2, waiting(20, duration));
      const double is = rate(streams, now), exact = least_of_deadlines(streams, now);
      EXPECT_GE(is, exact - 1e-9) << duration << " " << now;
      // The first of them are looked at together, as far as 25 ms reach.
      EXPECT_LE(is, 1.1 * exact + (now == -200 ? 0.2 : 0)) << duration << " " << now;
    }
  }
}

TEST(BusBudget, AFewRecordsAreLookedAtAtAnyPathTime) {
  for (const std::int64_t start : {0, 7, 1'000'000}) {
    const std::vector<NodeStream> streams(2, waiting(20, 40, start));
    EXPECT_NEAR(rate(streams, start - 1'500), rate(std::vector<NodeStream>(2, waiting(20, 40)), -1'500),
                1e-9);
    EXPECT_LT(rate(streams, start - 1'500), 0.25);
  }
}

TEST(BusBudget, LooksASecondAheadAndNoFarther) {
  // Many nodes, none of which has more than a queue full, all due within 2 ms: 4,080 records take the bus
  // 0.98 s, and need 0.12 s more.
  const auto at = [](double ahead_s) {
    const std::vector<NodeStream> streams(34, waiting(118, 1, 200'000));
    return rate(streams, 200'000 - static_cast<std::int64_t>(ahead_s / kSecondsPerUnit));
  };
  EXPECT_EQ(at(1.3), 1);
  EXPECT_LT(at(0.99), 0.95) << "the last of forty looks";
  EXPECT_GT(at(0.99), 0.85);
}

TEST(BusBudget, ANodeThatHasNothingDueAsksForNothing) {
  // The first has sent what is due in the next second; the other has not.
  NodeStream idle(1);
  idle.reset({}, 0, 0);
  idle.push_start();
  FittedSegment s;
  for (const std::int32_t duration : {100, 100, 40'000, 8'000, 8'000, 8'000, 8'000, 8'000, 8'000, 8'000}) {
    s.duration = duration;
    idle.push(s);
    s.start_units += duration;
  }
  idle.push_end();
  idle.release(0);
  ASSERT_TRUE(idle.on_status({}, {.free_records = 4}, units(0)));
  while (idle.next_frame({}, units(60'000))) {
  }
  ASSERT_EQ(idle.unsent(), 8u);
  std::vector<NodeStream> streams;
  streams.push_back(std::move(idle));
  streams.push_back(waiting(200, 10, 12'000));
  const double is = rate(streams, 1'000), exact = least_of_deadlines(streams, 1'000);
  EXPECT_LT(exact, 1);
  EXPECT_GE(is, exact - 1e-9);
  EXPECT_LE(is, 1.1 * exact);
}

}  // namespace
}  // namespace kinebus::testing
