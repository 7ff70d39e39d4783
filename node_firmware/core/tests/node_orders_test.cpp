// What a node makes of orders that come at the wrong time, in the wrong shape or in the wrong state; and what
// it tells, and how often, of what has gone wrong.

#include "node_firmware/core/tests/lone_bench.hpp"
#include "protocol/canopen/alarm_codes.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr std::uint32_t kInThisState = 0x0800'0022;

struct OrdersTest : LoneStreamTest {
  std::int64_t drive_faults() { return lone.counter(NodeCounter::kDriveFaults); }
  std::int64_t stops() { return lone.counter(NodeCounter::kCoordinatedStops); }
  bool stopped() const { return lone.stopped(); }
};

TEST_F(OrdersTest, ASyncOfTheWrongLengthIsNoneToTheClock) {
  const std::int64_t lost = lone.counter(NodeCounter::kStampLost);
  for (int i = 0; i < 4; ++i) {
    lone.send("080#");
    lone.sync();
  }
  EXPECT_EQ(lone.counter(NodeCounter::kStampLost), lost);
  EXPECT_EQ(lone.counter(NodeCounter::kRxMalformed), 4);
}

TEST_F(OrdersTest, AStoppedNodeTakesNothingBySdoAndAnswersNothing) {
  const std::int64_t before = lone.read(0x6065, 0);
  lone.send("000#0201");
  EXPECT_EQ(lone.write(0x6065, 0, 4, before + 5), kNoAnswer);
  EXPECT_EQ(lone.write(0x2110, 0, 8, 0), kNoAnswer) << "nor what it would refuse";
  lone.send("000#0101");
  EXPECT_EQ(lone.late_answer(), kNoAnswer) << "nor later";
  EXPECT_EQ(lone.read(0x6065, 0), before);
}

TEST_F(OrdersTest, AStoppedNodeIsMovedByNoSync) {
  EXPECT_EQ(lone.write(0x6060, 0, 1, 8), 0u);
  lone.power();
  lone.control(0x0F);
  lone.run(50ms);
  EXPECT_EQ(lone.write(0x607A, 0, 4, 400), 0u);
  lone.send("000#0201");
  lone.run(100ms);
  EXPECT_EQ(counts(), 0);
}

TEST_F(OrdersTest, WhatAllHearMayBeReadOfOneAlone) {
  EXPECT_EQ(lone.write(0x2111, 0, 8, 0), kInThisState);
  EXPECT_NE(lone.read_code(0x2111, 0), kInThisState);
}

TEST_F(OrdersTest, NmtAtRestStopsNobody) {
  follow();
  queue({600, -600});
  lone.send("000#8001");
  EXPECT_FALSE(stopped()) << "records wait, and path time stands";
  lone.send("000#0101");
  lone.send("000#8001");
  EXPECT_FALSE(stopped());
}

TEST_F(OrdersTest, NmtWhilePathTimeRunsToWhatIsQueuedStopsAll) {
  follow();
  queue({600, -600}, 60'000);
  lone.rate(1);
  ASSERT_FALSE(lone.node.moving(lone.now)) << "it begins later";
  lone.send("000#8001");
  EXPECT_TRUE(stopped());
  EXPECT_EQ(lone.told(node_emcy::kCommand), 1);
  lone.send("000#0101");
  lone.send("000#8001");
  EXPECT_EQ(lone.told(node_emcy::kCommand), 1) << "it stops already";
}

TEST_F(OrdersTest, NmtWhilePathTimeRunsWithNothingQueuedStopsNobody) {
  lone.rate(1);
  lone.send("000#8001");
  EXPECT_FALSE(stopped());
}

TEST_F(OrdersTest, PdosOfTheWrongLengthAreToldOnceUntilTheNextStart) {
  for (int round = 1; round <= 2; ++round) {
    for (int i = 0; i < 3; ++i) lone.send("201#0F");
    EXPECT_EQ(lone.told(0x8210), round);
    lone.send("201#0F00000000000000");
    lone.send("201#0F00000000000000");
    EXPECT_EQ(lone.told(0x8220), round);
    EXPECT_EQ(lone.counter(NodeCounter::kPdoLengthErrors), 5 * round);
    lone.send("000#0101");
  }
}

TEST_F(OrdersTest, ATransferThatIsNotGoneOnWithIsAborted) {
  lone.send("601#4040210700000000");
  EXPECT_EQ(lone.late_answer(), 0u);
  lone.wait(20s);
  EXPECT_EQ(lone.late_answer(), 0x0504'0000u);
}

TEST_F(OrdersTest, AMemoryIsWaitedForThoughABufferWasClearedBefore) {
  follow();
  queue({60'000, -60'000, 60'000, -60'000});
  lone.rate(1);
  lone.run(15ms);
  lone.rate(0);
  lone.run(100ms);
  EXPECT_EQ(lone.write(0x60C4, 6, 1, 0), kNoAnswer) << "it creeps to a whole count";
  lone.wait(200ms);
  EXPECT_EQ(lone.late_answer(), 0u);
  for (const int axis : {0, 1}) lone.unpower(axis);
  EXPECT_EQ(lone.write(0x1010, 1, 4, 0x6576'6173), kNoAnswer);
  lone.wait(100ms);
  lone.send("080#");
  EXPECT_EQ(lone.late_answer(), kNoAnswer);
  EXPECT_FALSE(lone.node.image_to_store().empty());
  lone.node.on_image_stored(true);
  lone.wait(1ms);
  EXPECT_EQ(lone.late_answer(), 0u);
}

TEST_F(OrdersTest, WhatWasStoredIsAnsweredByANodeThatMayAnswer) {
  EXPECT_EQ(lone.write(0x1010, 1, 4, 0x6576'6173), kNoAnswer);
  lone.send("000#0201");
  EXPECT_FALSE(lone.node.image_to_store().empty());
  lone.node.on_image_stored(true);
  lone.wait(1ms);
  EXPECT_EQ(lone.late_answer(), kNoAnswer);
}

TEST_F(OrdersTest, AStoppedNodeTellsOfNothingButStops) {
  lone.send("000#0201");
  lone.node.report(0x8110);
  lone.wait(50ms);
  EXPECT_EQ(lone.told(0x8110), 0);
  lone.node.on_axis_trouble(lone.now += 1ms, 0, 0x3220);
  lone.wait(50ms);
  EXPECT_EQ(lone.told(0x3220), 1) << "the others move";
}

TEST_F(OrdersTest, AStopThatIsAskedForLongAfterTheLastFrameLiesAhead) {
  for (const bool overheated : {true, false}) {
    lone.now += 30ms;  // nobody has called it for so long
    const LocalTime asked = lone.now;
    if (overheated)
      lone.node.on_axis_trouble(asked, 0, 0x4310);
    else
      lone.node.on_drive_fault(asked, 1, 0x2310);
    ASSERT_TRUE(lone.node.path().stop_start());
    EXPECT_GT(*lone.node.path().stop_start(), asked);
    EXPECT_LT(*lone.node.path().stop_start(), asked + 5ms);
    lone.wait(1ms);
    lone.clear_stop();
    ASSERT_FALSE(stopped());
  }
}

TEST_F(OrdersTest, AStopThatIsAskedForAgainCountsOnce) {
  const std::int64_t before = stops();
  lone.node.on_axis_trouble(lone.now += 1ms, 0, 0x4310);
  lone.node.on_axis_trouble(lone.now += 1ms, 1, 0x3220);
  lone.node.on_drive_fault(lone.now += 1ms, 0, 0x2310);
  lone.wait(5ms);
  EXPECT_EQ(stops(), before + 1);
  for (const int code : {0x4310, 0x3220, 0x2310})
    EXPECT_EQ(lone.told(static_cast<std::uint16_t>(code)), 1) << std::hex << code;
  EXPECT_EQ(drive_faults(), 3);
}

TEST_F(OrdersTest, TwoCausesAtOnceAreBothTold) {
  EXPECT_EQ(lone.write(0x2130, 6, 1, 7), 0u);
  EXPECT_EQ(lone.write(0x2130, 5, 1, static_cast<int>(SwitchFunction::kPositiveLimitA)), 0u);
  lone.rate(1);
  lone.node.on_switch(lone.now, 5, true);
  lone.node.on_switch(lone.now, 4, true);
  lone.now += 3ms;
  lone.node.on_time(lone.now);
  lone.wait(1ms);
  EXPECT_EQ(lone.told(node_emcy::kEmergencyStop), 1);
  EXPECT_EQ(lone.told(node_emcy::kLimitSwitch), 1);
}

TEST_F(OrdersTest, AFollowingErrorThatThePortTellsIsOverWhenThePortSaysSo) {
  lone.node.on_axis_trouble(lone.now += 1ms, 0, 0x8611);
  lone.wait(5ms);
  lone.clear_stop();
  lone.node.on_axis_trouble(lone.now += 1ms, 0, 0x8611);
  lone.wait(5ms);
  EXPECT_EQ(lone.told(0x8611), 1) << "it has not gone";
  EXPECT_FALSE(stopped());
  lone.node.on_axis_trouble_gone(0x8611);
  lone.node.on_axis_trouble(lone.now += 1ms, 0, 0x8611);
  lone.wait(5ms);
  EXPECT_EQ(lone.told(0x8611), 2);
  EXPECT_TRUE(stopped());
}

TEST_F(OrdersTest, AStreamsErrorIsOverWithItsBufferAndNotByAnyOrder) {
  follow();
  record({.duration = 100, .acceleration = {0, 0}});  // without START
  ASSERT_TRUE(lone.stream_flags() & StreamStatus::kSequenceError);
  lone.rate(0);
  EXPECT_TRUE(lone.stream_flags() & StreamStatus::kSequenceError) << "a hold clears nothing";
  EXPECT_EQ(lone.write(0x60C4, 6, 1, 0), 0u);
  EXPECT_FALSE(lone.stream_flags() & StreamStatus::kSequenceError);
}

TEST_F(OrdersTest, AClearThatIsRefusedClearsNoError) {
  EXPECT_EQ(lone.write(0x2113, 0, 2, 500), 0u);
  follow();
  lone.rate(1);
  record({.duration = 100, .acceleration = {0, 0}});
  lone.wait(20ms);
  lone.broadcast(RateCommand::Kind::kClear);
  EXPECT_TRUE(stopped()) << "it still ramps down";
  EXPECT_TRUE(lone.stream_flags() & StreamStatus::kSequenceError);
}

TEST_F(OrdersTest, TheStatusTellsPathTimeAndACheckOfItsTailOnlyWhereItIsAskedFor) {
  follow();
  lone.rate(1);
  lone.run(700ms);
  lone.rate(0);
  lone.run(100ms);
  queue({600, -600});
  const std::int64_t units = lone.node.path_time(lone.now).count() / kPathTicksPerUnit;
  ASSERT_GT(units, 30'000);
  const auto raw = static_cast<std::uint64_t>(lone.read(0x2102, 0));
  EXPECT_EQ(decode_stream_status(raw).path_units, units);
  EXPECT_EQ(raw >> 56, 0u);
  EXPECT_EQ(lone.write(0x2119, 0, 1, 1), 0u);
  EXPECT_NE(static_cast<std::uint64_t>(lone.read(0x2102, 0)) >> 56, 0u);
}

TEST_F(OrdersTest, AnEndThatComesInTimeIsInTime) {
  follow();
  for (const int late : {0, 1}) {
    queue({600, -600, -600, 600, 600, -600, -600, 600});
    lone.rate(1);
    lone.run(late == 0 ? 90ms : 120ms);
    record({.control = SegmentControl::kEnd});
    lone.run(200ms);
    EXPECT_FALSE(stopped()) << late;
    EXPECT_EQ(lone.node.user_position(lone.now, 0), state.position);
    lone.rate(0);
    lone.run(50ms);
  }
  EXPECT_EQ(lone.counter(NodeCounter::kUnderruns), 0);
}

TEST_F(OrdersTest, WithPowerAloneNoRecordMovesAnAxis) {
  EXPECT_EQ(lone.write(0x6060, 0, 1, 7), 0u);
  lone.power();
  queue({600, -600});
  EXPECT_TRUE(stopped());
  EXPECT_EQ(lone.told(node_emcy::kStream), 1);
}

TEST_F(OrdersTest, AnAxisStaysOnTheStreamUntilWhatIsQueuedIsOver) {
  follow();
  EXPECT_EQ(lone.read(0x6041, 0) & 0x1400, 0x1400) << "on the stream, which rests";
  queue({600, -600, -600, 600});
  record({.control = SegmentControl::kEnd});
  EXPECT_EQ(lone.write(0x6060, 0, 1, 1), 0u);
  lone.run(50ms);
  EXPECT_EQ(lone.read(0x6061, 0), 7) << "records wait";
  EXPECT_EQ(lone.read(0x6041, 0) & 0x1400, 0x1000) << "and will move";
  lone.rate(1);
  lone.run(20ms);
  EXPECT_EQ(lone.read(0x6041, 0) & 0x1400, 0x1000) << "which moves";
  lone.run(200ms);
  EXPECT_EQ(lone.node.user_position(lone.now, 0), state.position);
  EXPECT_EQ(lone.read(0x6061, 0), 1);
  EXPECT_FALSE(stopped());
}

TEST_F(OrdersTest, TheBufferOfTheStreamIsClearedWithoutTouchingAMotionOfAnAxisOwn) {
  lone.start_move();
  const double before = counts();
  EXPECT_EQ(lone.write(0x60C4, 6, 1, 0), 0u);
  lone.run(30ms);
  EXPECT_TRUE(lone.node.moving(lone.now));
  EXPECT_GT(counts(), before);
  lone.run(2s);
  EXPECT_EQ(counts(), 50'000);
}

TEST_F(OrdersTest, ACheckpointOfAnAxisThatStandsIsWhereItStands) {
  const auto checkpoint = [&](int axis, std::int64_t position) {
    CanFrame frame{.id = 0x501, .length = 8};
    put_u64_le(frame.data, encode(Checkpoint{sequence, static_cast<std::uint8_t>(axis), position}));
    lone.send(frame);
  };
  lone.start_move(1);
  lone.run(2s);
  ASSERT_EQ(counts(1), 50'000);
  checkpoint(1, from_counts(50'000));
  EXPECT_FALSE(stopped());
  checkpoint(1, from_counts(0));
  EXPECT_TRUE(stopped());
  EXPECT_EQ(lone.told(node_emcy::kCheckpoint), 1);
}

TEST_F(OrdersTest, AnEdgeInTheMidstOfTheStreamHasThePlaceOfItsInstant) {
  follow();
  EXPECT_EQ(lone.write(0x2130, 7, 1, static_cast<int>(SwitchFunction::kProbe)), 0u);
  queue({60'000, -60'000, -60'000, 60'000});
  record({.control = SegmentControl::kEnd});
  lone.rate(1);
  lone.now += 12ms;
  const LocalTime at = lone.now;
  lone.node.on_switch(at, 6, true);
  const std::int64_t there = lone.node.user_position(at, 0);
  lone.run(5ms);
  EXPECT_NE(lone.node.user_position(lone.now, 0), there);
  EXPECT_EQ(lone.read(0x2140, 8), there);
  lone.node.on_switch(lone.now, 6, false);
  lone.run(5ms);
  EXPECT_EQ(lone.read(0x2140, 8), there) << "of the edge that touches";
}

TEST_F(OrdersTest, AFaultWithoutAGatewayIsToldAndStopsBothAxes) {
  Lone other;
  other.send("000#0101");
  EXPECT_EQ(other.write(0x6007, 0, 2, 1), 0u);
  other.start_move();
  other.send("000#8001");
  other.wait(2ms);
  EXPECT_TRUE(other.stopped());
  EXPECT_EQ(other.told(node_emcy::kCommand), 1);
}

TEST_F(OrdersTest, AnEdgeWithoutDebouncingIsServedAtOnce) {
  EXPECT_EQ(lone.write(0x2130, 7, 1, 7), 0u);
  EXPECT_EQ(lone.write(0x2132, 7, 2, 0), 0u);
  lone.run(50ms);
  lone.node.on_switch(lone.now += 1ms, 6, true);
  EXPECT_TRUE(stopped());
  const auto frame = lone.node.next_frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->id, 0x081u);
}

TEST_F(OrdersTest, OtherCommandsOfLssStoreNothing) {
  lone.send("7E5#0401");
  EXPECT_TRUE(lone.node.image_to_store().empty());
  lone.send("7E5#0400");
  EXPECT_TRUE(lone.node.image_to_store().empty());
}

TEST_F(OrdersTest, WhatANodeTellsByItselfMayBeSetInMotion) {
  lone.start_move();
  for (const std::uint16_t index : {std::uint16_t{0x1800}, std::uint16_t{0x1801}, std::uint16_t{0x1803}})
    EXPECT_EQ(lone.write(index, 5, 2, 100), 0u) << std::hex << index;
  EXPECT_EQ(lone.write(0x607F, 0, 4, 1'000), kInThisState);
}

TEST_F(OrdersTest, HeartbeatsKeepTheirTimeWhateverIsWritten) {
  EXPECT_EQ(lone.write(0x1017, 0, 2, 50), 0u);
  lone.seen.clear();
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(lone.write(0x6065, 0, 4, 10 + i), 0u);
    lone.wait(19ms);
  }
  const auto beats = std::ranges::count_if(lone.seen, [](const CanFrame& f) { return f.id == 0x701; });
  EXPECT_GE(beats, 15);
  EXPECT_LE(beats, 17);
}

TEST_F(OrdersTest, AMasterThatIsLostIsFoundWhateverIsWritten) {
  EXPECT_EQ(lone.write(0x1016, 1, 4, 0x007F'0064), 0u);
  lone.send("77F#05");
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(lone.write(0x6065, 0, 4, 10 + i), 0u);
    lone.run(20ms);
  }
  EXPECT_EQ(lone.told(0x8130), 1);
}

TEST_F(OrdersTest, RpdosThatAreOffAreNotWaitedFor) {
  const auto before = lone.node.rpdo_cob_ids();
  ASSERT_EQ(before[0], 0x201);
  lone.send("000#8001");
  EXPECT_EQ(lone.write(0x1400, 1, 4, 0x8000'0201), 0u);
  EXPECT_EQ(lone.node.rpdo_cob_ids()[0], 0);
}

}  // namespace
}  // namespace kinebus::testing_bench
