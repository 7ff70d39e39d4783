#include "gateway/stream/bus_budget.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace kinebus::testing {
namespace {

PathTime units(std::int64_t n) {
  return PathTime{n * kPathTicksPerUnit};
}

/// A stream whose node has room for nothing more: all records wait, each of `duration` units.
NodeStream waiting(int count, std::int32_t duration) {
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
  stream.release(0);
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

}  // namespace
}  // namespace kinebus::testing
