// Who is not enabled, halted, stopped or on another path does not move, whatever it is asked for.

#include "node_firmware/core/tests/drive_bench.hpp"
#include "node_firmware/core/tests/stream_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr double kQuick = 6'400'000, kSlow = 1'280'000;

struct EnableTest : DriveTest {
  void mode(int mode, int axis = 0) {
    bench.write(kId, static_cast<std::uint16_t>(0x6060 + axis * 0x800), 0, 1, mode);
  }
  void expect_stays(BusTime span = 300ms) {
    const double here = counts();
    bench.run(span, 1ms, [&] { ASSERT_EQ(counts(), here); });
  }
  /// A motion by itself, at its speed.
  void start(std::int64_t to = 300'000) {
    bench.enable(kId, 0, 1);
    target(to);
    bench.run(200ms);
    ASSERT_TRUE(moves());
  }
  bool moves() { return bench.node().moving(bench.local()); }
  void emergency_stop(bool pressed) {
    bench.node().on_switch(bench.local(), 6, pressed);
    bench.run(2ms);
  }
  /// Two set-points: one that moves, one that waits.
  void start_two() {
    start(90'000);
    bench.write(kId, 0x607A, 0, 4, 200'000);
    control(0x0F);
    control(0x1F);
  }
};

TEST_F(EnableTest, WithPowerAloneNoSetPointMovesIt) {
  mode(1);
  control(0x06);
  control(0x07);
  ASSERT_TRUE(bench.node().drive(0).power);
  bench.write(kId, 0x607A, 0, 4, 50'000);
  control(0x17);
  expect_stays();
  // It is enabled with the bit set: that is no new set-point either.
  control(0x1F);
  ASSERT_EQ(status() & 0x6F, 0x27);
  expect_stays();
  EXPECT_EQ(bench.read(kId, 0x607A, 0), 0) << "where it is: what was written before counts no more";
  target(2'000);
  bench.run(1s);
  EXPECT_EQ(counts(), 2'000);
}

TEST_F(EnableTest, WithPowerAloneItDoesNotHome) {
  bench.write(kId, 0x6098, 0, 1, 20);
  mode(6);
  control(0x06);
  control(0x07);
  control(0x17);
  expect_stays();
  EXPECT_EQ(status() & 0x3000, 0);
  control(0x1F);
  expect_stays();
  control(0x0F);
  control(0x1F);
  bench.run(300ms);
  EXPECT_TRUE(moves()) << "the bit rises while it is enabled";
}

TEST_F(EnableTest, WithPowerAloneNoSyncMovesIt) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.start_sync(2ms);
  mode(8);
  control(0x06);
  control(0x07);
  bench.write(kId, 0x607A, 0, 4, 5'000);
  expect_stays(100ms);
  control(0x0F);
  expect_stays(100ms);
  bench.write(kId, 0x60C2, 1, 1, 2);
  bench.write(kId, 0x60B0, 0, 4, 100);
  bench.write(kId, 0x607A, 0, 4, 700);
  bench.run(500ms);
  EXPECT_EQ(counts(), 800) << "with its offset";
  control(0x07);
  bench.run(100ms);
  bench.write(kId, 0x607A, 0, 4, 100);
  expect_stays(100ms);
}

TEST_F(EnableTest, TheLineModeFollowsWhileItsBitIsSet) {
  bench.write(kId, 0x6065, 0, 4, 0xFFFF'FFFF);
  bench.write(kId, 0x60C0, 0, 2, 0);
  bench.write(kId, 0x60C2, 1, 1, 2);
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.start_sync(2ms);
  bench.enable(kId, 0, 7);
  bench.write(kId, 0x60C1, 1, 4, 400);
  expect_stays(50ms);
  control(0x1F);
  bench.run(300ms);
  EXPECT_EQ(counts(), 400);
  EXPECT_TRUE(status() & 0x1000) << "it interpolates";
  bench.write(kId, 0x60C1, 1, 4, 40'000);
  bench.run(50ms);
  ASSERT_TRUE(moves());
  control(0x0F);
  watch(300ms, 600'000, kSlow);
  EXPECT_FALSE(moves()) << "a ramp, and no more";
  EXPECT_NE(counts(), 40'000) << "it does not end where it was told to go";
  EXPECT_FALSE(status() & 0x1000);
  bench.write(kId, 0x60C1, 1, 4, 0);
  expect_stays(100ms);
}

TEST_F(EnableTest, NoSetPointIsTakenInTheMidstOfAQuickStop) {
  start();
  control(0x0B);
  bench.run(5ms);
  ASSERT_EQ(status() & 0x6F, 0x07);
  ASSERT_TRUE(moves());
  bench.write(kId, 0x607A, 0, 4, 290'000);
  control(0x1B);
  watch(300ms, 130'000, kQuick);
  EXPECT_FALSE(moves());
  expect_stays();
  EXPECT_LT(counts(), 50'000);
}

TEST_F(EnableTest, AHaltDoesNotSoftenTheStopOfAll) {
  bench.write(kId, 0x2130, 7, 1, 7);
  start();
  const double from = counts();
  emergency_stop(true);
  control(0x10F);
  bench.run(60ms);
  EXPECT_FALSE(moves()) << "20 ms of the quick stop, not 100 ms of a halt";
  EXPECT_LT(counts() - from, 2'500);
}

TEST_F(EnableTest, WhatIsHaltedDoesNotGoOnBehindAStopOfAll) {
  bench.write(kId, 0x2130, 7, 1, 7);
  start();
  control(0x10F);
  bench.run(200ms);
  ASSERT_FALSE(moves());
  emergency_stop(true);
  control(0x0F);
  expect_stays();
  emergency_stop(false);
  control(0x8F);
  control(0x0F);
  expect_stays();
}

TEST_F(EnableTest, AHaltBehindAStopOfAllLeavesNothingThatGoesOn) {
  bench.write(kId, 0x2130, 7, 1, 7);
  start();
  emergency_stop(true);
  bench.run(100ms);
  control(0x10F);
  emergency_stop(false);
  control(0x18F);
  control(0x10F);
  control(0x0F);
  expect_stays();
}

TEST_F(EnableTest, ASetPointThatWaitsIsDroppedByAStopOfAll) {
  bench.write(kId, 0x2130, 7, 1, 7);
  start_two();
  emergency_stop(true);
  bench.run(100ms);
  ASSERT_FALSE(moves());
  emergency_stop(false);
  control(0x9F);
  control(0x1F);
  expect_stays();
}

TEST_F(EnableTest, ASetPointThatWaitsIsDroppedByAQuickStopAndByDisabling) {
  for (const int word : {0x0B, 0x07}) {
    bench.enable(kId, 0, 1);
    target(static_cast<std::int64_t>(counts()) + 60'000);
    bench.run(100ms);
    bench.write(kId, 0x607A, 0, 4, static_cast<std::int64_t>(counts()) + 200'000);
    control(0x0F);
    control(0x1F);
    control(word | 0x10);
    bench.run(200ms);
    ASSERT_FALSE(moves());
    control(0x1F);
    EXPECT_EQ(status() & 0x6F, 0x27);
    expect_stays();
  }
}

TEST_F(EnableTest, DisabledWithoutARampNothingThatWaitsGoesOn) {
  bench.write(kId, 0x605C, 0, 2, 0);
  start_two();
  control(0x17);
  watch(100ms, 130'000, kQuick);
  EXPECT_FALSE(moves());
  EXPECT_TRUE(bench.node().drive(0).power);
  control(0x1F);
  expect_stays();
}

TEST_F(EnableTest, AnEnabledAxisThatRestsIsNotStoppedByItsSwitchingOff) {
  bench.write(kId, 0x605C, 0, 2, 0);
  bench.enable(kId, 0, 1);
  control(0x07);
  bench.run(10ms);
  EXPECT_FALSE(bench.node().path().stop_latched());
  EXPECT_EQ(status() & 0x6F, 0x23);
}

TEST_F(EnableTest, HomingThatIsHaltedBeginsAnewAndEnds) {
  bench.write(kId, 0x6098, 0, 1, 20);
  bench.enable(kId, 0, 6);
  control(0x1F);
  bench.run(400ms);
  ASSERT_TRUE(moves());
  control(0x11F);
  bench.run(200ms);
  ASSERT_FALSE(moves());
  expect_stays();
  EXPECT_EQ(status() & 0x1000, 0);
  control(0x10F);
  control(0x0F);
  expect_stays();  // its start bit has fallen meanwhile
  control(0x1F);
  bench.run(200ms);
  control(0x11F);
  bench.run(200ms);
  control(0x1F);
  bench.run(12s);
  EXPECT_EQ(status() & 0x3400, 0x1400) << "it goes on by itself when the halt ends";
}

TEST_F(EnableTest, HomingThatAStopOfAllHasEndedDoesNotGoOn) {
  bench.write(kId, 0x2130, 7, 1, 7);
  bench.write(kId, 0x6098, 0, 1, 20);
  bench.enable(kId, 0, 6);
  control(0x1F);
  bench.run(400ms);
  emergency_stop(true);
  bench.run(100ms);
  ASSERT_FALSE(moves());
  EXPECT_EQ(status() & 0x1000, 0) << "not at home";
  control(0x11F);
  control(0x1F);
  expect_stays();
  emergency_stop(false);
  control(0x9F);
  control(0x1F);
  expect_stays(2s);
  EXPECT_EQ(status() & 0x3000, 0);
}

TEST_F(EnableTest, HomingThatDisablingEndsDoesNotGoOnWithoutARampEither) {
  bench.write(kId, 0x605C, 0, 2, 0);
  bench.write(kId, 0x6098, 0, 1, 20);
  bench.enable(kId, 0, 6);
  control(0x1F);
  bench.run(400ms);
  control(0x17);
  watch(100ms, 130'000, kQuick);
  control(0x1F);
  expect_stays(1s);
  EXPECT_EQ(status() & 0x3000, 0);
}

/// Axes of which one is on the stream.
struct OneOfTwoTest : StreamTest {
  void follow_first_alone() {
    bench.write(1, 0x6840, 0, 2, 0x07);
    bench.run(5ms);
  }
};

TEST_F(OneOfTwoTest, AnAxisDoesNotJoinAStreamThatRuns) {
  follow_first_alone();
  bench.write(1, 0x6860, 0, 1, 1);
  bench.run(5ms);
  const std::int64_t at = tau_units() + 1'000;
  bench.send(feeds[0].start(at));
  for (const int sign : {1, -1, -1, 1}) bench.send(feeds[0].segment(5'000, sign * 300'000, 0));
  bench.send(feeds[0].end());
  bench.run(20ms);
  bench.rate(1.0);
  bench.run(100ms);
  ASSERT_NE(bench.position(0, 0), 0);
  bench.write(1, 0x6860, 0, 1, 7);
  bench.write(1, 0x6840, 0, 2, 0x0F);
  bench.run(20ms);
  EXPECT_EQ(bench.statusword(1, 1) & 0x6F, 0x27);
  EXPECT_EQ(bench.statusword(1, 1) & 0x1000, 0) << "it is not on it";
  EXPECT_FALSE(bench.node().path().stop_latched());
  bench.run(500ms);
  EXPECT_EQ(bench.statusword(1, 1) & 0x1000, 0x1000) << "now it rests, and the axis is";
  EXPECT_EQ(bench.position(0, 1), 0);
  EXPECT_EQ(bench.node().user_position(bench.local(), 0), feeds[0].state[0].position);
}

TEST_F(OneOfTwoTest, ARecordForAnAxisThatDoesNotFollowStopsAll) {
  bench.write(1, 0x6860, 0, 1, 1);
  bench.run(5ms);
  bench.send(feeds[0].start(tau_units() + 1'000));
  bench.send(feeds[0].segment(1'250, 0, 1));
  bench.run(20ms);
  EXPECT_TRUE(bench.node().path().stop_latched());
  ASSERT_TRUE(bench.last(0x081));
  EXPECT_EQ(get_u16_le(bench.last(0x081)->data), 0xFF04);
}

TEST_F(OneOfTwoTest, AQuickStopStopsNobodyWhereNothingOfItsStreamIsUnderWay) {
  bench.write(1, 0x6040, 0, 2, 0x0B);
  bench.run(10ms);
  EXPECT_FALSE(bench.node().path().stop_latched()) << "all rests";
  EXPECT_EQ(bench.statusword(1, 0) & 0x6F, 0x07);
  bench.write(1, 0x6040, 0, 2, 0x0F);
  start_all(5'000);
  wave(1);
  end_all();
  bench.run(20ms);
  bench.write(1, 0x6840, 0, 2, 0x0B);
  bench.run(10ms);
  EXPECT_FALSE(bench.node().path().stop_latched()) << "what is queued waits";
}

}  // namespace
}  // namespace kinebus::testing_bench
