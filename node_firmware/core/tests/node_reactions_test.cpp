// What faults, stops and lost masters do to a motion and to what waits behind it, and how it is told.

#include "node_firmware/core/tests/drive_bench.hpp"
#include "node_firmware/core/tests/lone_bench.hpp"
#include "protocol/canopen/alarm_codes.hpp"

namespace kinebus::testing_bench {
namespace {

struct ReactionsTest : DriveTest {
  bool moves() { return bench.node().moving(bench.local()); }
  void start(std::int64_t to = 300'000) {
    bench.enable(kId, 0, 1);
    target(to);
    bench.run(300ms);
    ASSERT_TRUE(moves());
  }
  void home_by(int method) {
    bench.write(kId, 0x6098, 0, 1, method);
    bench.enable(kId, 0, 6);
    control(0x1F);
    bench.run(200ms);
    ASSERT_TRUE(moves());
  }
  int told(std::uint16_t code) {
    return static_cast<int>(std::ranges::count_if(bench.seen, [&](const Bench::Seen& seen) {
      return seen.frame.id == 0x081 && get_u16_le(seen.frame.data) == code;
    }));
  }
  void emergency_stop(bool pressed) {
    bench.node().on_switch(bench.local(), 6, pressed);
    bench.run(2ms);
    bench.run(2ms);
  }
};

/// 605Eh: the ramp of a fault that keeps its power; 605Ah: of the quick stop.
class Ramps : public ReactionsTest, public testing::WithParamInterface<bool> {};

TEST_P(Ramps, AreThoseThatTheOptionsName) {
  const bool slow = GetParam();
  for (const bool fault : {true, false}) {
    SCOPED_TRACE(fault);
    bench.write(kId, 0x6084, 0, 4, 200'000);
    bench.write(kId, 0x6085, 0, 4, 2'000'000);
    bench.write(kId, 0x605E, 0, 2, slow ? 1 : 2);
    bench.write(kId, 0x605A, 0, 2, slow ? 1 : 2);
    bench.write(kId, 0x6007, 0, 2, fault ? 1 : 3);
    start(fault ? 300'000 : 0);
    const auto speed = static_cast<double>(bench.read(kId, 0x606C, 0));
    const double from = counts();
    if (fault)
      bench.send("000#8001");
    else
      control(0x0B);
    bench.run(1ms);
    bench.run(2s);
    EXPECT_FALSE(moves());
    // A fault asks all to stop: by the quick stop's ramp in any case.
    const double way = speed * speed / 2 / (slow && !fault ? 200'000 : 2'000'000);
    EXPECT_NEAR(std::abs(counts() - from), way, way / 10 + std::abs(speed) * 2e-3);
    EXPECT_EQ(status() & 0x4F, fault ? 0x08 : 0x40);
    if (fault) {
      EXPECT_EQ(told(node_emcy::kCommand), 1);
      control(0x80);
      control(0x00);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(SlowAndQuick, Ramps, testing::Bool());

TEST_F(ReactionsTest, HomingThatLosesItsPowerIsNoHomingError) {
  home_by(20);
  bench.node().on_drive_fault(bench.local(), 0, 0x2310);
  bench.run(1ms);
  bench.run(1s);
  EXPECT_EQ(told(node_emcy::kHoming), 0);
  EXPECT_EQ(status() & 0x2000, 0);
  EXPECT_EQ(bench.read(kId, 0x2140, 6), 0);
}

TEST_F(ReactionsTest, HomingThatAQuickStopEndsIsNoHomingErrorAndDoesNotGoOn) {
  home_by(20);
  control(0x1B);
  bench.run(1s);
  EXPECT_EQ(told(node_emcy::kHoming), 0);
  EXPECT_EQ(status() & 0x3000, 0);
  for (const int word : {0x16, 0x17, 0x1F}) control(word);
  const double here = counts();
  bench.run(300ms);
  EXPECT_EQ(counts(), here) << "its bit did not rise while it was enabled";
}

TEST_F(ReactionsTest, HomingThatIsHaltedWhenAllStopDoesNotBeginAgain) {
  bench.write(kId, 0x2130, 7, 1, 7);
  home_by(20);
  control(0x11F);
  bench.run(300ms);
  ASSERT_FALSE(moves());
  emergency_stop(true);
  emergency_stop(false);
  control(0x19F);
  bench.run(5ms);
  ASSERT_FALSE(bench.node().path().stop_latched());
  control(0x1F);
  const double here = counts();
  bench.run(500ms);
  EXPECT_EQ(counts(), here);
}

TEST_F(ReactionsTest, HaltedWithASetPointThatWaitsItStandsAndGoesOnToBoth) {
  start(60'000);
  bench.write(kId, 0x607A, 0, 4, 10'000);
  control(0x0F);
  control(0x1F);
  ASSERT_TRUE(moves());
  control(0x11F);
  bench.run(2ms);
  EXPECT_EQ(status() & 0x0400, 0) << "it brakes";
  bench.run(500ms);
  EXPECT_EQ(status() & 0x0400, 0x0400) << "it stands";
  const double here = counts();
  bench.run(200ms);
  EXPECT_EQ(counts(), here);
  control(0x1F);
  bench.run(10ms);
  EXPECT_EQ(status() & 0x0400, 0);
  bench.run(3s);
  EXPECT_EQ(counts(), 10'000);
  EXPECT_EQ(status() & 0x0400, 0x0400);
}

TEST_F(ReactionsTest, AHaltThatDisablingEndsIsForgotten) {
  start();
  control(0x10F);
  bench.run(500ms);
  ASSERT_FALSE(moves());
  control(0x07);
  control(0x0F);
  const double here = counts();
  bench.run(300ms);
  EXPECT_EQ(counts(), here) << "enabled anew it does not go on";
  EXPECT_EQ(status() & 0x6F, 0x27);
}

TEST_F(ReactionsTest, AQuickStopAtRestIsOverAtOnce) {
  bench.write(kId, 0x605A, 0, 2, 2);
  bench.enable(kId, 0, 1);
  control(0x0B);
  bench.run(5ms);
  EXPECT_EQ(status() & 0x4F, 0x40) << "switched off";
}

TEST_F(ReactionsTest, WhatIsDisabledWithoutARampInTheStreamIsToldOnce) {
  bench.bring_up();
  bench.write(kId, 0x605C, 0, 2, 0);
  for (const int axis : {0, 1}) bench.enable(kId, axis, 7);
  const std::int64_t at = bench.node().path_time(bench.local()).count() / kPathTicksPerUnit + 500;
  std::uint8_t sequence = 0;
  const auto record = [&](Segment segment) {
    segment.sequence = sequence++;
    CanFrame frame{.id = 0x401, .length = 8};
    put_u64_le(frame.data, encode(segment));
    bench.send(frame);
  };
  record({.control = SegmentControl::kStart, .start_units = at});
  for (int i = 0; i < 20; ++i)
    record({.duration = 1250, .acceleration = {i % 4 == 0 || i % 4 == 3 ? 90'000 : -90'000, 0}});
  bench.run(20ms);
  bench.rate(1);
  bench.run(60ms);
  ASSERT_TRUE(moves());
  bench.seen.clear();
  control(0x07);
  bench.run(300ms);
  EXPECT_FALSE(moves());
  EXPECT_EQ(told(node_emcy::kCommand), 1);
}

TEST_F(ReactionsTest, ByLoadItHomesWhereADriverTellsOfIt) {
  bench.write(kId, 0x6098, 0, 1, -3);
  bench.enable(kId, 0, 6);
  const auto begins = [&](int threshold, std::uint8_t driver) {
    bench.write(kId, 0x2170, 3, 1, threshold);
    bench.node().set_driver(0, {.state = driver, .found = 2209});
    control(0x0F);
    control(0x1F);
    bench.run(20ms);
    const bool begun = moves();
    EXPECT_EQ(status() & 0x2000, begun ? 0 : 0x2000);
    control(0x0F);
    bench.run(500ms);
    return begun;
  };
  EXPECT_FALSE(begins(0, DriverReport::kConfigured)) << "no threshold: nothing is looked for";
  EXPECT_EQ(told(node_emcy::kHoming), 1);
  EXPECT_EQ(bench.read(kId, 0x2120, static_cast<std::uint8_t>(NodeCounter::kHomingErrors)), 1);
  EXPECT_TRUE(begins(100, DriverReport::kConfigured));
  EXPECT_FALSE(begins(100, 0)) << "no driver";
  EXPECT_EQ(bench.read(kId, 0x2120, static_cast<std::uint8_t>(NodeCounter::kHomingErrors)), 2);
}

TEST_F(ReactionsTest, TheFirstCarriageWaitsForTheSecondToo) {
  for (const int axis : {0, 1}) {
    bench.write(kId, static_cast<std::uint16_t>(0x6098 + axis * 0x800), 0, 1, 20);
    bench.enable(kId, axis, 6);
  }
  bench.plant_on = false;
  for (const int axis : {0, 1}) bench.node().on_switch(bench.local(), axis, true);
  bench.run(5ms);
  control(0x1F, 1);
  bench.run(50ms);
  control(0x1F, 0);
  bench.run(50ms);
  EXPECT_LT(counts(1), 0) << "it leaves";
  EXPECT_EQ(counts(0), 0) << "it waits";
  EXPECT_TRUE(status(0) & 0x4000);
}

TEST_F(ReactionsTest, TheGuardsBitBeginsAnewWithAReset) {
  bench.write(kId, 0x1017, 0, 2, 0);
  bench.send("701#R");
  bench.run(5ms);
  bench.send("000#8201");
  bench.run(5ms);
  bench.write(kId, 0x1017, 0, 2, 0);
  bench.seen.clear();
  bench.send("701#R");
  bench.run(5ms);
  ASSERT_NE(bench.last(0x701), nullptr);
  EXPECT_EQ(text_of(*bench.last(0x701)), "701#7F");
}

TEST_F(ReactionsTest, WhoHasLostItsMasterSendsNoPdo) {
  bench.send("000#0101");
  bench.write(kId, 0x1016, 1, 4, 0x7F'0032);
  bench.write(kId, 0x1029, 1, 1, 0);
  bench.send("77F#05");
  bench.run(200ms);
  ASSERT_EQ(told(emcy::kHeartbeat), 1);
  bench.seen.clear();
  control(0x06);
  control(0x07);
  bench.run(200ms);
  EXPECT_FALSE(bench.was_seen(0x181)) << "its statusword has changed, in pre-operational";
}

struct ReactionsOfOne : LoneStreamTest {};

TEST_F(ReactionsOfOne, AStreamsErrorIsOverWithTheStopThatAFaultResetLifts) {
  Lone other;
  other.send("000#0101");
  CanFrame frame{.id = 0x401, .length = 8};
  put_u64_le(frame.data, encode(Segment{.sequence = 0, .duration = 100, .acceleration = {0, 0}}));
  other.send(frame);
  ASSERT_TRUE(other.stopped());
  ASSERT_TRUE(other.stream_flags() & StreamStatus::kSequenceError);
  other.control(0x80);
  EXPECT_FALSE(other.stopped());
  EXPECT_FALSE(other.stream_flags() & StreamStatus::kSequenceError);
}

TEST_F(ReactionsOfOne, AStampAloneBringsNoSyncBack) {
  lone.wait(1s);
  ASSERT_FALSE(lone.stream_flags() & StreamStatus::kSynchronised);
  lone.send(encode(SyncStamp{.counter = 200, .epoch = 1, .time = lone.now}));
  EXPECT_FALSE(lone.stream_flags() & StreamStatus::kSynchronised);
  lone.run(50ms);
  EXPECT_TRUE(lone.stream_flags() & StreamStatus::kSynchronised);
}

TEST_F(ReactionsOfOne, OnlyAProbeIsAProbe) {
  EXPECT_EQ(lone.write(0x2130, 7, 1, static_cast<int>(SwitchFunction::kProbe)), 0u);
  for (const std::uint16_t index : {std::uint16_t{0x60B8}, std::uint16_t{0x68B8}})
    EXPECT_EQ(lone.write(index, 0, 2, index == 0x60B8 ? 0x0033 : 0x0023), 0u);
  lone.start_move();
  const std::int64_t before = lone.read(0x2140, 8);
  lone.node.on_switch(lone.now, 0, true);
  lone.wait(2ms);
  EXPECT_EQ(lone.read(0x60B9, 0) & 0x0006, 0) << "a home switch";
  EXPECT_EQ(lone.read(0x2140, 8), before);
  const std::int64_t touched = lone.node.user_position(lone.now, 0);
  lone.node.on_switch(lone.now, 6, true);
  lone.wait(2ms);
  EXPECT_EQ(lone.read(0x60B9, 0) & 0x0006, 0x0002);
  EXPECT_EQ(lone.read(0x2140, 8), touched);
  lone.node.on_switch(lone.now, 6, false);
  lone.wait(2ms);
  EXPECT_EQ(lone.read(0x2140, 8), touched);
  EXPECT_EQ(lone.read(0x60B9, 0) & 0x0006, 0x0006) << "both edges";
  EXPECT_EQ(lone.read(0x68B9, 0) & 0x0006, 0x0004) << "of the other axis one is asked for";
}

TEST_F(ReactionsOfOne, WhatRanOutDoesNotGoOnUntilItsBufferIsCleared) {
  follow();
  queue({600, -600});
  lone.rate(1);
  stand_still(300ms);
  ASSERT_TRUE(lone.stopped());
  lone.run(100ms);
  lone.clear_stop();
  ASSERT_FALSE(lone.stopped());
  lone.rate(1);
  EXPECT_TRUE(lone.stopped());
  EXPECT_EQ(lone.told(node_emcy::kStream), 1);
}

TEST_F(ReactionsOfOne, ABusThatTakesNothingIsNoReasonToLeaveTheWatchdogUnfed) {
  EXPECT_EQ(lone.write(0x1017, 0, 2, 20), 0u);
  lone.node.report(0x8110);
  for (int i = 0; i < 100; ++i) lone.node.on_time(lone.now += 3ms);
  EXPECT_TRUE(lone.node.healthy(lone.now));
}

TEST_F(ReactionsOfOne, WithoutAnInputForAScaleItsDirectionIsStillTaken) {
  EXPECT_EQ(lone.write(0x2160, 3, 1, 1), 0u);
  EXPECT_EQ(lone.write(0x2160, 1, 1, 1), static_cast<std::uint32_t>(AbortCode::kHardware));
}

TEST_F(ReactionsOfOne, ABufferClearWaitsForTheSecondAxisToo) {
  follow();
  record({.control = SegmentControl::kStart,
          .start_units = lone.node.path_time(lone.now).count() / kPathTicksPerUnit + 100});
  for (const std::int32_t a : {60'000, -60'000}) record({.duration = 1250, .acceleration = {0, a}});
  lone.rate(1);
  lone.run(15ms);
  lone.rate(0);
  lone.run(100ms);
  EXPECT_EQ(lone.write(0x60C4, 6, 1, 0), kNoAnswer);
  lone.wait(200ms);
  EXPECT_EQ(lone.late_answer(), 0u);
  EXPECT_EQ(lone.node.user_position(lone.now, 1) % kOneCount, 0);
}

TEST_F(ReactionsOfOne, EachAxisIsTunedByItsOwnOrder) {
  lone.power(1);
  EXPECT_EQ(lone.write(0x2950, 8, 1, 1), 0u);
  EXPECT_FALSE(lone.node.take_tune_request(0));
  EXPECT_TRUE(lone.node.take_tune_request(1));
}

/// 2133h in TPDO1: a change is told in each of its frames, and not held back for 20 ms once it is out.
TEST_F(ReactionsOfOne, AnInputIsShownAnewOnceItsFrameIsOut) {
  lone.send("000#8001");
  EXPECT_EQ(lone.write(0x1800, 1, 4, 0xC000'0181), 0u);
  EXPECT_EQ(lone.write(0x1A00, 0, 1, 0), 0u);
  EXPECT_EQ(lone.write(0x1A00, 1, 4, 0x2133'0008), 0u);
  EXPECT_EQ(lone.write(0x1A00, 0, 1, 1), 0u);
  EXPECT_EQ(lone.write(0x1800, 2, 1, 255), 0u);
  EXPECT_EQ(lone.write(0x1800, 3, 2, 0), 0u);
  EXPECT_EQ(lone.write(0x1800, 1, 4, 0x4000'0181), 0u);
  lone.send("000#0101");
  lone.wait(100ms);
  lone.seen.clear();
  for (const bool level : {true, false, true, false}) {
    lone.node.on_switch(lone.now, 6, level);
    lone.wait(2ms);
  }
  std::string told;
  for (const CanFrame& frame : lone.seen)
    if (frame.id == 0x181) told += text_of(frame) + " ";
  EXPECT_EQ(told, "181#40 181#00 181#40 181#00 ");
}

}  // namespace
}  // namespace kinebus::testing_bench
