// What bounds an axis: its travel once the position is known, limit switches, and power without which nothing
// is known.

#include "node_firmware/core/tests/drive_bench.hpp"
#include "node_firmware/core/tests/stream_bench.hpp"

namespace kinebus::testing_bench {
namespace {

struct LimitsTest : DriveTest {
  /// Here is 0, and the travel is -5,000 to 5,000 counts.
  void know_the_position(int axis = 0) {
    const auto at = [&](int index) { return static_cast<std::uint16_t>(index + axis * 0x800); };
    bench.write(kId, at(0x607D), 1, 4, -5'000);
    bench.write(kId, at(0x607D), 2, 4, 5'000);
    bench.write(kId, at(0x6098), 0, 1, 37);
    bench.enable(kId, axis, 6);
    control(0x1F, axis);
    bench.run(5ms);
    EXPECT_EQ(status(axis) & 0x3400, 0x1400) << "at home";
  }
  void cut_power(int axis = 0) {
    control(0x00, axis);
    bench.run(5ms);
    EXPECT_FALSE(bench.node().drive(axis).power);
  }
};

TEST_F(LimitsTest, ANegativeLimitSwitchLeavesOnlyTheWayUp) {
  bench.write(kId, 0x2130, 6, 1, 5);
  bench.enable(kId, 0, 1);
  target(-50'000);
  watch(300ms, 128'000, 1'280'000);
  bench.node().on_switch(bench.local(), 5, true);
  watch(500ms, 128'000, 6'400'000);
  const double there = counts();
  EXPECT_LT(there, -1'000);
  EXPECT_GT(there, -50'000);
  control(0x8F);
  control(0x0F);
  target(-50'000);
  watch(200ms, 1, 1);
  target(0);
  bench.run(1500ms);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), 0);
}

TEST_F(LimitsTest, ALimitSwitchOfOneAxisDoesNotBoundTheOther) {
  bench.write(kId, 0x2130, 6, 1, 6);  // negative limit of B
  bench.node().on_switch(bench.local(), 5, true);
  bench.run(5ms);
  bench.enable(kId, 0, 1);
  target(-5'000);
  bench.run(1s);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), -5'000);
  bench.enable(kId, 1, 1);
  bench.write(kId, 0x687A, 0, 4, -5'000);
  control(0x0F, 1);
  control(0x1F, 1);
  bench.run(1s);
  EXPECT_EQ(bench.read(kId, 0x6864, 0), 0);
}

TEST_F(LimitsTest, TheLowerEndOfTheTravelHoldsToo) {
  know_the_position();
  bench.write(kId, 0x6060, 0, 1, 1);
  target(-9'000);
  EXPECT_TRUE(status() & (1 << 11));
  bench.run(500ms);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), -5'000);
}

TEST_F(LimitsTest, AnAxisThatWasWithoutPowerKnowsNoPosition) {
  know_the_position();
  cut_power();
  // It may have been turned by hand: what the travel is counted from is gone.
  bench.enable(kId, 0, 1);
  target(9'000);
  EXPECT_FALSE(status() & (1 << 11));
  bench.run(1s);
  EXPECT_EQ(bench.read(kId, 0x6064, 0), 9'000);
}

TEST_F(LimitsTest, HomingThatLostItsPowerDoesNotGoOnByItself) {
  bench.write(kId, 0x6098, 0, 1, 20);
  bench.enable(kId, 0, 6);
  control(0x1F);
  watch(500ms, 38'400, 1'280'000);
  EXPECT_GT(counts(), 1'000);
  cut_power();
  for (const int word : {0x06, 0x07, 0x0F}) control(word);
  EXPECT_EQ(status() & 0x6F, 0x27);
  watch(500ms, 1, 1);
  EXPECT_EQ(status() & 0x1000, 0) << "not at home";
  control(0x1F);
  bench.run(8s);
  EXPECT_EQ(status() & 0x3400, 0x1400) << "asked for, it homes";
}

TEST_F(LimitsTest, CyclicSetPointsBeyondTheTravelStopAtItsEnds) {
  bench.write(kId, 0x6065, 0, 4, 0xFFFF'FFFF);
  know_the_position();
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.write(kId, 0x60C2, 1, 1, 2);
  bench.write(kId, 0x6060, 0, 1, 8);
  bench.start_sync(2ms);
  bench.run(10ms);
  for (const int end : {9'000, -9'000}) {
    bench.write(kId, 0x607A, 0, 4, end);
    bench.run(1500ms, 1ms, [&] { EXPECT_LE(std::abs(counts()), 5'001); });
    EXPECT_EQ(bench.read(kId, 0x6064, 0), end / 9 * 5);
    EXPECT_TRUE(status() & (1 << 11)) << "it says that it is limited";
  }
}

struct StreamLimitsTest : StreamTest {
  /// The first axis of node 1 knows where it is, follows the stream again, and may go so far.
  void know_the_position(int min, int max) {
    bench.write(1, 0x607D, 1, 4, min);
    bench.write(1, 0x607D, 2, 4, max);
    bench.write(1, 0x6098, 0, 1, 37);
    bench.write(1, 0x6040, 0, 2, 0x06);
    bench.enable(1, 0, 6);
    bench.write(1, 0x6040, 0, 2, 0x1F);
    bench.run(5ms);
    bench.write(1, 0x6040, 0, 2, 0x0F);
    bench.write(1, 0x6060, 0, 1, 7);
    bench.run(5ms);
  }
  /// There and, at rest, no farther.
  void move_within() {
    start_all(2000);
    for (const int sign : {1, -1})
      for (Feed& feed : feeds) bench.send(feed.segment(1250, sign * way * 393'216, 0));
    end_all();
    bench.run(50ms);
    bench.rate(1.0);
    bench.run(200ms);
  }
  int way = 1;
};

/// A stream of 40 ms that goes 1,145 counts away, one way or the other.
class TravelOfAStream : public StreamLimitsTest, public testing::WithParamInterface<int> {};

TEST_P(TravelOfAStream, ARecordBeyondItsEndStopsAllBeforeItMoves) {
  know_the_position(-500, 500);
  start_all(2000);
  for (const int sign : {1, -1})
    for (Feed& feed : feeds) bench.send(feed.segment(1250, sign * GetParam() * 393'216, 0));
  bench.run(50ms);
  EXPECT_TRUE(status(0).flags & StreamStatus::kStopped);
  EXPECT_EQ(bench.position(0, 0), 0);
  ASSERT_TRUE(bench.last(0x081));
  EXPECT_EQ(get_u16_le(bench.last(0x081)->data), 0xFF04) << text_of(*bench.last(0x081));
  bench.rate(1.0);
  bench.run(100ms);
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_EQ(bench.position(i, 0), 0) << "stopped, all of them";
}

TEST_P(TravelOfAStream, OneWithinItIsTaken) {
  know_the_position(-1'500, 1'500);
  way = GetParam();
  move_within();
  EXPECT_NEAR(std::ldexp(static_cast<double>(bench.position(0, 0)), -32), GetParam() * 1145.0, 1.0);
}
INSTANTIATE_TEST_SUITE_P(BothWays, TravelOfAStream, testing::Values(1, -1));

TEST_F(StreamTest, AnNmtStopOfOneNodeInMotionStopsAllOnThePath) {
  move_through_wave(6, 200ms);
  bench.stranger_sends(nmt_frame(NmtCommand::kStop, 2));
  watch(200ms);
  EXPECT_TRUE(all_rest());
  EXPECT_LE(skew_us(), kSkewUs);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_TRUE(bench.node(i).path().stop_latched()) << i;
    EXPECT_TRUE(bench.node(i).drive(0).power) << i;
  }
}

}  // namespace
}  // namespace kinebus::testing_bench
