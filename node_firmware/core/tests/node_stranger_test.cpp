// What another master, a tool or a lost frame may do to a node: nothing jumps, nothing goes on unseen, and
// the node says what it refuses.

#include "node_firmware/core/tests/stream_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr std::uint32_t kRefusedInMotion = 0x0800'0022;
constexpr std::uint8_t kMine = 1;

/// One axis in the midst of a profile move, without a gateway.
struct StrangerTest : testing::Test {
  StrangerTest() : bench(std::vector<NodeSetup>{{.id = kMine}}) {}
  void move(int axis = 0) {
    const auto at = [&](int index) { return static_cast<std::uint16_t>(index + axis * 0x800); };
    bench.enable(kMine, axis, 1);
    bench.write(kMine, at(0x607A), 0, 4, 90'000);
    bench.write(kMine, at(0x6040), 0, 2, 0x1F);
    bench.run(300ms);
    ASSERT_TRUE(moves());
  }
  bool moves() { return bench.node().moving(bench.local()); }
  double counts(int axis = 0) { return std::ldexp(static_cast<double>(bench.position(0, axis)), -32); }
  /// Comes to rest within the quick stop's ramp, without a step of its speed.
  void expect_ramp() {
    double last = counts(), last_speed = -1;
    bench.run(120ms, 1ms, [&] {
      const double speed = (counts() - last) * 1000;
      if (last_speed >= 0) {
        EXPECT_LE(std::abs(speed - last_speed), 6'400 * 1.01 + 20);
      }
      last = counts();
      last_speed = speed;
    });
    EXPECT_FALSE(moves());
    EXPECT_LT(counts(), 60'000);
  }
  Bench bench;
};

TEST_F(StrangerTest, WhatAMotionReliesOnIsNotWrittenWhileItRuns) {
  struct Write {
    std::uint16_t index;
    std::uint8_t sub;
    int size;
    std::int64_t value;
  };
  const Write writes[] = {{0x2140, 4, 1, 1},  {0x2140, 2, 2, 0}, {0x2140, 3, 2, 0}, {0x2940, 4, 1, 1},
                          {0x2113, 0, 2, 2},  {0x2130, 1, 1, 3}, {0x1017, 0, 2, 0}, {0x1016, 1, 4, 0},
                          {0x607D, 2, 4, 9},  {0x605C, 0, 2, 0}, {0x6085, 0, 4, 1}, {0x607F, 0, 4, 9},
                          {0x6007, 0, 2, 0},  {0x6807, 0, 2, 0}, {0x1600, 0, 1, 0}, {0x60C6, 0, 4, 1},
                          {0x2114, 0, 2, 99}, {0x1029, 1, 1, 2}};
  move();
  for (const Write& w : writes)
    EXPECT_EQ(bench.try_write(kMine, w.index, w.sub, w.size, w.value), kRefusedInMotion)
        << std::hex << w.index << ":" << int{w.sub};
  // What the next set-point takes may be written.
  bench.write(kMine, 0x6081, 0, 4, 64'000);
  bench.write(kMine, 0x6084, 0, 4, 900'000);
  EXPECT_TRUE(moves());
  bench.run(2s);
  EXPECT_EQ(bench.read(kMine, 0x6064, 0), 90'000);
  for (const Write& w : writes)
    if (w.index != 0x1600) {
      EXPECT_EQ(bench.try_write(kMine, w.index, w.sub, w.size, w.value), 0u) << w.index;
    }
}

TEST_F(StrangerTest, DisableOperationWithoutARampStopsTheMotorAndKeepsItsCurrent) {
  bench.write(kMine, 0x605C, 0, 2, 0);
  move();
  bench.write(kMine, 0x6040, 0, 2, 0x07);
  EXPECT_EQ(bench.statusword(kMine, 0) & 0x6F, 0x23);
  expect_ramp();
  EXPECT_TRUE(bench.node().drive(0).power);
  EXPECT_EQ(bench.statusword(kMine, 0) & 0x6F, 0x23);
}

TEST_F(StrangerTest, NmtStopPreOperationalAndResetCommunicationEndAProfileMove) {
  for (const char* command : {"000#0201", "000#8001", "000#8201"}) {
    bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
    bench.write(kMine, 0x6040, 0, 2, 0x0F);
    bench.enable(kMine, 0, 1);
    bench.write(kMine, 0x607A, 0, 4, 0);
    bench.write(kMine, 0x6040, 0, 2, 0x3F);
    bench.run(2s);
    move();
    bench.send(command);
    expect_ramp();
    EXPECT_TRUE(bench.node().drive(0).power) << command;
    bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
    bench.run(5ms);
    EXPECT_EQ(bench.statusword(kMine, 0) & 0x6F, 0x07) << "quick stop active";
  }
}

TEST_F(StrangerTest, AbortConnectionOptionSaysWhatNmtDoesToAMove) {
  bench.write(kMine, 0x6007, 0, 2, 0);
  move();
  bench.send("000#8001");
  bench.run(2s);
  EXPECT_EQ(bench.read(kMine, 0x6064, 0), 90'000) << "0: it goes on";
  bench.write(kMine, 0x6007, 0, 2, 1);
  bench.write(kMine, 0x607A, 0, 4, 0);
  bench.write(kMine, 0x6040, 0, 2, 0x0F);
  bench.write(kMine, 0x6040, 0, 2, 0x1F);
  bench.run(300ms);
  bench.send("000#8001");
  bench.run(300ms);
  EXPECT_EQ(bench.statusword(kMine, 0) & 0x4F, 0x08) << "1: fault";
  EXPECT_EQ(bench.try_write(kMine, 0x6007, 0, 2, 4), 0x0609'0031u);
}

TEST_F(StrangerTest, AnOverdueRpdoIsToldAtOnceAndIsOverWhenItComes) {
  bench.write(kMine, 0x1017, 0, 2, 5'000);
  bench.write(kMine, 0x1400, 5, 2, 40);
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.send("201#000000000000");
  const BusTime from = bench.now;
  bench.run(60ms);
  ASSERT_TRUE(bench.was_seen(0x081));
  for (const Bench::Seen& seen : bench.seen)
    if (seen.frame.id == 0x081) {
      EXPECT_LE(seen.at - from, 42ms);
    }
  EXPECT_EQ(get_u16_le(bench.last(0x081)->data), 0x8250);
  EXPECT_NE(bench.read(kMine, 0x1001, 0), 0);
  bench.send("201#000000000000");
  bench.run(5ms);
  EXPECT_EQ(get_u16_le(bench.last(0x081)->data), 0x0000);
  EXPECT_EQ(bench.read(kMine, 0x1001, 0), 0);
}

TEST_F(StrangerTest, LssIsNotHeardInMotion) {
  move();
  for (const char* frame : {"7E5#0401000000000000", "7E5#1109000000000000", "7E5#0400000000000000"})
    bench.send(frame);
  bench.run(3s);
  EXPECT_FALSE(bench.was_seen(0x7E4));
  ASSERT_FALSE(moves());
  bench.send("000#8201");
  bench.run(50ms);
  EXPECT_EQ(bench.node().node_id(), kMine);
}

// Rates, stamps and records are for all nodes of a gateway, at rest, too: motion that waits begins by them.
TEST_F(StreamTest, NoSdoTellsOneNodeAloneWhatAllHear) {
  for (const std::uint16_t index : std::initializer_list<std::uint16_t>{0x2100, 0x2101, 0x2110, 0x2111})
    EXPECT_EQ(bench.try_write(2, index, 0, 4, 0), kRefusedInMotion) << std::hex << index;
}

TEST_F(StreamTest, WhoHasTheAnswerToABufferClearReadsWhereTheAxesStay) {
  // At rest in the midst of a segment: no whole count.
  for (int i = 0; i < 20; ++i) {
    for (Feed& feed : feeds) feed.sequence = bench.node(feed.id - 1u).path().stream().next_sequence();
    for (Feed& feed : feeds)
      for (std::size_t axis = 0; axis < 2; ++axis)
        feed.state[axis] = {
            bench.node(feed.id - 1u).user_position(bench.local(feed.id - 1u), static_cast<int>(axis)), 0};
    move_through_wave(2, 30ms + i * 1700us);
    bench.rate(0.0);
    watch(150ms);
    ASSERT_TRUE(all_rest());
    std::array<std::array<std::int64_t, 2>, kNodes> told{};
    for (std::uint8_t id = 1; id <= kNodes; ++id) {
      bench.write(id, 0x60C4, 6, 1, 0);
      for (int axis = 0; axis < 2; ++axis)
        told[id - 1u][static_cast<std::size_t>(axis)] =
            bench.node(id - 1u).user_position(bench.local(id - 1u), axis);
    }
    bench.run(50ms);
    for (std::uint8_t id = 1; id <= kNodes; ++id)
      for (int axis = 0; axis < 2; ++axis)
        EXPECT_EQ(bench.node(id - 1u).user_position(bench.local(id - 1u), axis),
                  told[id - 1u][static_cast<std::size_t>(axis)])
            << "node " << int{id} << " axis " << axis << " time " << i;
  }
}

TEST_F(StreamTest, ADriveDisabledWithoutARampStopsAllOnThePath) {
  bench.write(2, 0x605C, 0, 2, 0);
  move_through_wave(6, 200ms);
  EXPECT_EQ(bench.try_write(2, 0x2113, 0, 2, 2), kRefusedInMotion);
  EXPECT_EQ(bench.try_write(2, 0x2140, 4, 1, 1), kRefusedInMotion);
  EXPECT_FALSE(all_rest());
  bench.write(2, 0x6040, 0, 2, 0x07);
  watch(150ms);
  expect_stopped_together();
}

}  // namespace
}  // namespace kinebus::testing_bench
