// From mode to mode: each begins where the axis is, takes nothing of the one before with it, and shows its
// own bits.

#include "node_firmware/core/tests/drive_bench.hpp"
#include "protocol/canopen/alarm_codes.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr int kReached = 0x0400, kLimited = 0x0800, kBit12 = 0x1000, kBit13 = 0x2000;

struct ModesTest : DriveTest {
  void mode(int mode) { bench.write(kId, 0x6060, 0, 1, mode); }
  int shown_mode() { return static_cast<int>(bench.read(kId, 0x6061, 0)); }
  bool moves() { return bench.node().moving(bench.local()); }
  void stays(BusTime span = 100ms) {
    const double here = counts();
    bench.run(span, 1ms, [&] { ASSERT_EQ(counts(), here); });
  }
  void operational(BusTime sync = 2ms) {
    bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
    bench.write(kId, 0x60C2, 1, 1, sync / 1ms);
    bench.start_sync(sync);
    bench.run(20ms);
  }
  void home_here() {
    bench.write(kId, 0x6098, 0, 1, 35);
    bench.enable(kId, 0, 6);
    control(0x1F);
    bench.run(20ms);
    ASSERT_TRUE(status() & kBit12);
    control(0x0F);
    bench.run(2ms);
    ASSERT_TRUE(status() & kBit12) << "it stays at home when the bit falls";
  }
  void limits(std::int64_t low, std::int64_t high) {
    bench.write(kId, 0x607D, 1, 4, low);
    bench.write(kId, 0x607D, 2, 4, high);
  }
};

TEST_F(ModesTest, ASetPointsBitThatRisesTogetherWithEnablingIsNone) {
  mode(1);
  control(0x06);
  control(0x07);
  bench.write(kId, 0x607A, 0, 4, 50'000);
  EXPECT_EQ(bench.read(kId, 0x607A, 0), 50'000);
  control(0x1F);
  stays();
  EXPECT_FALSE(status() & kBit12) << "and is not acknowledged";
  EXPECT_EQ(bench.read(kId, 0x607A, 0), 0);
}

TEST_F(ModesTest, TheBitsOfOtherModesMoveNothing) {
  bench.enable(kId, 0, 3);
  bench.write(kId, 0x60FF, 0, 4, 20'000);
  bench.run(300ms);
  bench.write(kId, 0x607A, 0, 4, -500);
  control(0x1F);
  bench.run(300ms);
  EXPECT_EQ(bench.read(kId, 0x606C, 0), 20'000) << "no set-point of mode 1";
  bench.write(kId, 0x60FF, 0, 4, 0);
  bench.run(300ms);
  mode(0);
  bench.write(kId, 0x607A, 0, 4, -500);
  control(0x0F);
  control(0x1F);
  stays();
}

TEST_F(ModesTest, SyncMovesNoAxisInAModeWithoutSetPointsOfIt) {
  bench.write(kId, 0x60C0, 0, 2, 0);
  operational();
  bench.enable(kId, 0, 1);
  bench.write(kId, 0x60C1, 1, 4, 5'000);
  control(0x1F);
  stays();
}

TEST_F(ModesTest, WhatIsAskedForBeforeAModeBeginsHoldsInTheOneThatIsNamed) {
  bench.enable(kId, 0, 1);
  bench.write(kId, 0x60FF, 0, 4, 10'000);
  mode(3);
  bench.run(300ms);
  EXPECT_EQ(bench.read(kId, 0x606C, 0), 10'000);
  bench.write(kId, 0x60FF, 0, 4, 0);
  bench.run(300ms);
  bench.write(kId, 0x607A, 0, 4, 7'000);
  mode(1);
  EXPECT_EQ(bench.read(kId, 0x607A, 0), 7'000);
  EXPECT_EQ(bench.read(kId, 0x60C1, 1), std::lround(counts()));
  operational();
  const double here = counts();
  mode(8);
  EXPECT_EQ(bench.read(kId, 0x607A, 0), std::lround(here));
  stays();
}

TEST_F(ModesTest, ALineBeginsWhereTheAxisIsWhateverTheLastOneDid) {
  operational();
  bench.enable(kId, 0, 8);
  bench.write(kId, 0x607A, 0, 4, 800);
  bench.run(500ms);
  ASSERT_EQ(counts(), 800);
  EXPECT_TRUE(status() & kReached);
  EXPECT_TRUE(status() & kBit12) << "it follows";
  mode(1);
  EXPECT_FALSE(status() & kBit12);
  target(5'000);
  bench.run(1s);
  ASSERT_EQ(counts(), 5'000);
  mode(8);
  watch(100ms, 0, 0);
  EXPECT_EQ(counts(), 5'000);
  bench.write(kId, 0x607A, 0, 4, 5'400);
  bench.run(4ms);
  EXPECT_FALSE(status() & kReached) << "on its way";
  bench.run(500ms);
  EXPECT_EQ(counts(), 5'400);
  EXPECT_TRUE(status() & kReached);
}

TEST_F(ModesTest, ALineThatWasLeftInMotionBeginsWhereTheAxisIs) {
  operational(20ms);
  bench.enable(kId, 0, 8);
  for (int at = 0; at <= 980; at += 70) {
    bench.write(kId, 0x607A, 0, 4, at);
    bench.run(19ms - (bench.now.count() % 20'000'000) * 1ns + 1ms);
  }
  ASSERT_TRUE(moves());
  mode(1);
  bench.run(100ms);
  target(5'000);
  bench.run(1s);
  ASSERT_EQ(counts(), 5'000);
  mode(8);
  stays();
  EXPECT_EQ(counts(), 5'000);
}

TEST_F(ModesTest, ALineIsLeftInMotionThoughSyncGoesOn) {
  bench.write(kId, 0x6065, 0, 4, 0xFFFF'FFFF);
  operational();
  bench.enable(kId, 0, 8);
  bench.write(kId, 0x607F, 0, 4, 100'000);
  bench.write(kId, 0x607A, 0, 4, 90'000);
  bench.run(100ms);
  ASSERT_TRUE(moves());
  mode(1);
  bench.run(1s);
  EXPECT_EQ(shown_mode(), 1);
  EXPECT_LT(counts(), 90'000);
  target(100);
  bench.run(2s);
  EXPECT_EQ(counts(), 100);
}

TEST_F(ModesTest, ALineThatIsAskedForAgainWhileItBrakesBeginsFromRest) {
  bench.write(kId, 0x6065, 0, 4, 0xFFFF'FFFF);
  bench.write(kId, 0x60C0, 0, 2, 0);
  operational();
  bench.enable(kId, 0, 7);
  bench.write(kId, 0x60C1, 1, 4, 90'000);
  control(0x1F);
  bench.run(200ms);
  ASSERT_TRUE(moves());
  EXPECT_FALSE(status() & kReached);
  control(0x0F);
  bench.run(5ms);
  ASSERT_TRUE(moves());
  control(0x1F);
  watch(1500ms, 1'000'000, 6'400'000);
  EXPECT_EQ(counts(), 90'000);
  EXPECT_TRUE(status() & kReached);
}

TEST_F(ModesTest, EveryModeIsLeftByARampEachTime) {
  bench.enable(kId, 0, 3);
  for (int i = 0; i < 3; ++i) {
    mode(3);
    bench.write(kId, 0x60FF, 0, 4, 50'000);
    bench.run(200ms);
    ASSERT_TRUE(moves()) << i;
    mode(1);
    bench.run(300ms);
    EXPECT_FALSE(moves()) << i;
    EXPECT_EQ(shown_mode(), 1) << i;
  }
  mode(3);
  bench.write(kId, 0x60FF, 0, 4, 50'000);
  bench.run(200ms);
  mode(1);
  bench.run(2ms);
  mode(3);  // before it rests: it was not left
  bench.run(300ms);
  EXPECT_EQ(bench.read(kId, 0x606C, 0), 50'000);
}

TEST_F(ModesTest, HomingThatAnotherModeEndsIsNoErrorAndIsOver) {
  bench.write(kId, 0x6098, 0, 1, 20);
  bench.enable(kId, 0, 6);
  control(0x1F);
  bench.run(100ms);
  ASSERT_TRUE(moves());
  mode(1);
  bench.run(1s);
  EXPECT_FALSE(moves());
  EXPECT_FALSE(bench.was_seen(0x081)) << "no homing error";
  stays();
}

TEST_F(ModesTest, ACarriageThatWaitedOnItsSwitchInAnotherModeDoesNotLeaveIt) {
  bench.write(kId, 0x6098, 0, 1, 20);
  bench.plant_on = false;
  bench.node().on_switch(bench.local(), 0, true);
  bench.run(5ms);
  bench.enable(kId, 0, 6);
  control(0x81F);
  bench.run(50ms);
  ASSERT_TRUE(status() & 0x4000) << "it waits";
  EXPECT_FALSE(status() & kReached);
  mode(1);
  bench.run(5ms);
  control(0x1F);
  stays(300ms);
}

TEST_F(ModesTest, RelativeTargetsCountFromWhereAnotherModeHasLeftIt) {
  bench.enable(kId, 0, 1);
  target(1'000);
  bench.run(500ms);
  mode(3);
  bench.write(kId, 0x60FF, 0, 4, 10'000);
  bench.run(300ms);
  bench.write(kId, 0x60FF, 0, 4, 0);
  bench.run(300ms);
  const double here = counts();
  ASSERT_GT(here, 2'000);
  mode(1);
  bench.write(kId, 0x607A, 0, 4, 100);
  control(0x4F);
  control(0x5F);
  bench.run(300ms);
  EXPECT_EQ(counts(), here + 100);
}

TEST_F(ModesTest, ATargetThatWasCutIsToldUntilThereIsAnother) {
  home_here();
  limits(-100'000, 1'000);
  mode(1);
  const auto cut = [&] {
    target(5'000);
    bench.run(500ms);
    ASSERT_EQ(counts(), 1'000);
    ASSERT_TRUE(status() & kLimited);
  };
  cut();
  target(500);
  EXPECT_FALSE(status() & kLimited) << "by the next set-point";
  bench.run(500ms);
  cut();
  mode(6);
  EXPECT_FALSE(status() & kLimited) << "by another mode";
  mode(3);
  bench.write(kId, 0x60FF, 0, 4, 3'000);
  bench.run(100ms);
  EXPECT_TRUE(status() & kLimited) << "it stands where it may not go on";
  bench.write(kId, 0x60FF, 0, 4, 0);
  bench.run(100ms);
  EXPECT_FALSE(status() & kLimited);
  mode(1);
  cut();
  control(0x07);
  control(0x0F);
  EXPECT_FALSE(status() & kLimited) << "by enabling it anew";
  cut();
  bench.send("000#8101");
  bench.run(20ms);
  EXPECT_FALSE(status() & kLimited) << "by a reset";
}

TEST_F(ModesTest, AStopOfAllIsALimitThatIsTold) {
  bench.write(kId, 0x2130, 7, 1, 7);
  bench.enable(kId, 0, 1);
  EXPECT_FALSE(status() & kLimited);
  bench.node().on_switch(bench.local(), 6, true);
  bench.run(5ms);
  EXPECT_TRUE(status() & kLimited);
}

TEST_F(ModesTest, OutsideOfItsLimitsNothingMoves) {
  home_here();
  mode(1);
  target(2'000);
  bench.run(500ms);
  bench.write(kId, 0x2130, 1, 1, static_cast<int>(SwitchFunction::kNegativeLimitA));
  bench.plant_on = false;
  bench.node().on_switch(bench.local(), 0, true);
  bench.run(5ms);
  limits(-100'000, 1'000);
  target(500);
  stays();
  EXPECT_TRUE(status() & kLimited);
}

TEST_F(ModesTest, WithoutSyncALineStopsAtItsLimitsToo) {
  home_here();
  limits(-1'000, 1'000);
  bench.write(kId, 0x6065, 0, 4, 0xFFFF'FFFF);
  operational(20ms);
  mode(8);
  for (const int sign : {1, -1}) {
    for (int at = 0; at <= 980; at += 70) {
      bench.write(kId, 0x607A, 0, 4, sign * at);
      bench.run(19ms - (bench.now.count() % 20'000'000) * 1ns + 1ms);
    }
    bench.stop_sync();
    bench.run(1ms);
    double farthest = 0;
    bench.run(300ms, 1ms, [&] { farthest = std::max(farthest, sign * counts()); });
    EXPECT_GT(farthest, 981) << "it went on";
    EXPECT_LE(farthest, 1'000.01);
    for (const int word : {0x8F, 0x0F}) control(word);
    bench.start_sync(20ms);
    bench.run(300ms);  // its clock is synchronised by the stamps: the gateway lifts the stop
    bench.command(RateCommand::Kind::kClear);
    bench.run(50ms);
    bench.write(kId, 0x607A, 0, 4, 0);
    bench.run(1s);
    ASSERT_EQ(counts(), 0);
  }
}

TEST_F(ModesTest, ALineIsNotBoundByATravelOfWhichNobodyKnowsWhereItIs) {
  limits(-1'000, 1'000);
  bench.enable(kId, 0, 8);
  EXPECT_FALSE(status() & kBit12) << "no SYNC has come: it follows nothing";
  operational(20ms);
  for (int at = 0; at <= 2'100; at += 70) {
    bench.write(kId, 0x607A, 0, 4, at);
    bench.run(19ms - (bench.now.count() % 20'000'000) * 1ns + 1ms);
  }
  bench.run(500ms);
  EXPECT_EQ(counts(), 2'100);
}

TEST_F(ModesTest, ASetPointThatIsFarForAShortTimeStopsNobody) {
  operational();
  bench.write(kId, 0x6065, 0, 4, 100);
  bench.write(kId, 0x6066, 0, 2, 200);
  bench.enable(kId, 0, 8);
  bench.write(kId, 0x607A, 0, 4, 3'000);
  bench.run(500ms);
  EXPECT_EQ(counts(), 3'000);
  EXPECT_FALSE(bench.was_seen(0x081));
  EXPECT_FALSE(status() & kBit13);
}

TEST_F(ModesTest, TheMethodsSwitchIsALimitUnlessItHomes) {
  bench.write(kId, 0x2130, 1, 1, static_cast<int>(SwitchFunction::kNegativeLimitA));
  bench.write(kId, 0x6098, 0, 1, 17);
  bench.plant_on = false;
  bench.enable(kId, 0, 1);
  target(50'000);
  bench.run(100ms);
  bench.node().on_switch(bench.local(), 0, true);
  bench.run(1ms);
  bench.run(300ms);
  EXPECT_TRUE(bench.was_seen(0x081));
  EXPECT_LT(counts(), 40'000);
}

TEST_F(ModesTest, AFaultResetBehindAnNmtResetIsAnEdge) {
  bench.write(kId, 0x2130, 7, 1, 7);
  bench.enable(kId, 0, 1);
  control(0x8F);
  bench.node().on_switch(bench.local(), 6, true);
  bench.run(5ms);
  bench.node().on_switch(bench.local(), 6, false);
  bench.run(5ms);
  ASSERT_TRUE(bench.node().path().stop_latched());
  bench.send("000#8101");
  bench.run(20ms);
  ASSERT_TRUE(bench.node().path().stop_latched());
  control(0x80);
  bench.run(5ms);
  EXPECT_FALSE(bench.node().path().stop_latched());
}

}  // namespace
}  // namespace kinebus::testing_bench
