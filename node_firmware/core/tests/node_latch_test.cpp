// What makes a node ask for a stop of all, when it does not, and what is left of it afterwards.

#include "node_firmware/core/tests/lone_bench.hpp"

namespace kinebus::testing_bench {
namespace {

struct LatchTest : LoneStreamTest {};

TEST_F(LatchTest, AProcessorThatWasHeldUpPastTheEndOfItsRecordsStaysThereAndStopsAll) {
  follow();
  queue({600'000, 0, 0});
  lone.rate(1);
  ASSERT_FALSE(lone.stopped());
  stand_still(100ms);
  EXPECT_TRUE(lone.stopped());
  EXPECT_EQ(lone.told(node_emcy::kStarved), 1);
  EXPECT_EQ(lone.counter(NodeCounter::kUnderruns), 1);
  EXPECT_TRUE(lone.stream_flags() & StreamStatus::kUnderrun);
  EXPECT_EQ(lone.node.user_position(lone.now, 0), state.position) << "where the last record ends";
  lone.run(100ms);
  EXPECT_EQ(lone.node.user_position(lone.now, 0), state.position);
  EXPECT_EQ(lone.counter(NodeCounter::kUnderruns), 1) << "told and counted once";
  EXPECT_EQ(lone.told(node_emcy::kStarved), 1);
  EXPECT_TRUE(lone.node.drive(0).power);

  // The stop is lifted and the others are let go: this one has no way to go.
  lone.clear_stop();
  ASSERT_FALSE(lone.stopped());
  record({.duration = 1250});
  EXPECT_EQ(lone.node.user_position(lone.now, 0), state.position);
  lone.clear_stop();
  lone.rate(1);
  EXPECT_TRUE(lone.stopped());
  lone.run(50ms);
  EXPECT_EQ(lone.node.user_position(lone.now, 0), state.position);

  EXPECT_EQ(lone.write(0x60C4, 6, 1, 0), kNoAnswer) << "the axis creeps to its whole count first";
  lone.run(200ms);
  EXPECT_EQ(lone.late_answer(), 0u);
  lone.clear_stop();
  EXPECT_EQ(lone.stream_flags() & (StreamStatus::kUnderrun | StreamStatus::kStopped), 0);
  EXPECT_EQ(lone.read(0x1001, 0), 0);
  lone.rate(1);
  EXPECT_FALSE(lone.stopped());
}

TEST_F(LatchTest, RecordsThatEndInTimeAreNotStarved) {
  follow();
  queue({600'000, -600'000});
  record({.control = SegmentControl::kEnd});
  lone.rate(1);
  stand_still(100ms);
  lone.run(200ms);
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.counter(NodeCounter::kUnderruns), 0);
  EXPECT_EQ(lone.node.user_position(lone.now, 0), state.position);
  EXPECT_TRUE(lone.stream_flags() & StreamStatus::kAtRest);
}

TEST_F(LatchTest, AnOverrunStopsOnlyWhereSomethingIsQueuedOrUnderWay) {
  lone.node.on_receive_overrun(lone.now, 2);
  lone.run(10ms);
  EXPECT_FALSE(lone.stopped()) << "nothing is";
  EXPECT_EQ(lone.told(emcy::kCanOverrun), 0);
  EXPECT_EQ(lone.counter(NodeCounter::kRxOverrun), 2);
  follow();
  queue({600'000, -600'000}, 20'000);
  lone.node.on_receive_overrun(lone.now, 0);
  lone.run(10ms);
  EXPECT_FALSE(lone.stopped()) << "no frame was lost";
  EXPECT_EQ(lone.counter(NodeCounter::kRxOverrun), 2);
  lone.node.on_receive_overrun(lone.now, 1);
  lone.run(10ms);
  EXPECT_TRUE(lone.stopped()) << "one of them may have been the start";
  EXPECT_EQ(lone.told(emcy::kCanOverrun), 1);
  EXPECT_EQ(lone.counter(NodeCounter::kRxOverrun), 3);
}

TEST_F(LatchTest, AnOverrunWhilePathTimeRunsStopsItThoughNothingIsQueued) {
  lone.rate(1);
  ASSERT_NE(lone.node.path_rate_q32(lone.now), 0u);
  lone.node.on_receive_overrun(lone.now, 1);
  lone.run(10ms);
  EXPECT_TRUE(lone.stopped()) << "it may have been the hold";
  EXPECT_EQ(lone.node.path_rate_q32(lone.now), 0u);
}

TEST_F(LatchTest, AnOverrunWhileAStopIsLatchedIsCountedAndAsksForNoOther) {
  follow();
  queue({600'000, -600'000}, 20'000);
  lone.broadcast(RateCommand::Kind::kStop);
  ASSERT_TRUE(lone.stopped());
  const std::int64_t stops = lone.counter(NodeCounter::kCoordinatedStops);
  lone.node.on_receive_overrun(lone.now, 5);
  lone.run(10ms);
  EXPECT_EQ(lone.counter(NodeCounter::kRxOverrun), 5);
  EXPECT_EQ(lone.told(emcy::kCanOverrun), 0);
  EXPECT_EQ(lone.counter(NodeCounter::kCoordinatedStops), stops);
}

TEST_F(LatchTest, TheEmergencyStopIsToldOncePerPressAndEveryPressStops) {
  ASSERT_EQ(lone.write(0x2130, 7, 1, 7), 0u);
  for (int press = 1; press <= 2; ++press) {
    lone.node.on_switch(lone.now, 6, true);
    lone.run(50ms);
    EXPECT_TRUE(lone.stopped()) << press;
    EXPECT_EQ(lone.told(node_emcy::kEmergencyStop), press);
    lone.clear_stop();
    EXPECT_TRUE(lone.stopped()) << "pressed";
    lone.node.on_switch(lone.now, 6, false);
    lone.run(50ms);
    EXPECT_TRUE(lone.stopped()) << "let go, not cleared";
    EXPECT_NE(lone.read(0x1001, 0), 0);
    lone.clear_stop();
    EXPECT_FALSE(lone.stopped()) << press;
    EXPECT_EQ(lone.read(0x1001, 0), 0) << "it is over";
  }
}

TEST_F(LatchTest, ALimitSwitchStopsPathTimeThatRunsEveryTimeItComes) {
  ASSERT_EQ(lone.write(0x2130, 4, 1, 4), 0u);
  lone.node.on_switch(lone.now, 3, true);
  lone.run(10ms);
  EXPECT_FALSE(lone.stopped()) << "all rests";
  lone.node.on_switch(lone.now, 3, false);
  lone.run(10ms);
  for (int times = 1; times <= 2; ++times) {
    lone.rate(1);
    ASSERT_FALSE(lone.stopped());
    lone.node.on_switch(lone.now, 3, true);
    lone.run(10ms);
    EXPECT_TRUE(lone.stopped()) << times;
    EXPECT_EQ(lone.told(node_emcy::kLimitSwitch), times);
    lone.clear_stop();
    lone.node.on_switch(lone.now, 3, false);
    lone.run(10ms);
  }
}

TEST_F(LatchTest, TheSecondStopBrakesAMotionOfAnAxisOwnAsTheFirst) {
  ASSERT_EQ(lone.write(0x2130, 7, 1, 7), 0u);
  ASSERT_EQ(lone.write(0x6060, 0, 1, 1), 0u);
  lone.power();
  lone.control(0x0F);
  for (int press = 1; press <= 2; ++press) {
    ASSERT_EQ(lone.write(0x607A, 0, 4, press * 400'000), 0u);
    lone.control(0x1F);
    lone.run(200ms);
    ASSERT_TRUE(lone.node.moving(lone.now)) << press;
    lone.node.on_switch(lone.now, 6, true);
    lone.run(100ms);
    EXPECT_FALSE(lone.node.moving(lone.now)) << press;
    EXPECT_TRUE(lone.node.drive(0).power);
    lone.node.on_switch(lone.now, 6, false);
    lone.run(10ms);
    lone.control(0x0F);
    lone.clear_stop();
    lone.run(100ms);
    EXPECT_FALSE(lone.node.moving(lone.now)) << "what was asked for before is forgotten";
  }
}

TEST_F(LatchTest, WithAGatewayNoFaultResetLiftsTheStopOfAll) {
  lone.broadcast(RateCommand::Kind::kStop);
  ASSERT_TRUE(lone.stopped());
  lone.control(0x80);
  lone.control(0x00);
  EXPECT_TRUE(lone.stopped()) << "one node alone would go on";
  lone.clear_stop();
  EXPECT_FALSE(lone.stopped());
}

TEST_F(LatchTest, ABufferClearIsAnsweredWhenTheAxisRestsWhateverTheMemoryDoes) {
  lone.send("7E5#0401000000000000");
  lone.send("7E5#1700000000000000");               // LSS: store, which the port has not come to yet
  ASSERT_EQ(lone.write(0x6084, 0, 4, 1'000), 0u);  // so that it takes its time
  follow();
  queue({600'000, 0, 0, 0, 0, 0, 0, 0});
  lone.rate(1);
  lone.broadcast(RateCommand::Kind::kStop);
  ASSERT_EQ(lone.write(0x60C4, 6, 1, 0), kNoAnswer);
  EXPECT_TRUE(lone.node.image_to_store().empty()) << "power has come";
  lone.wait(1ms);
  EXPECT_EQ(lone.late_answer(), kNoAnswer) << "the axis still creeps";
  EXPECT_TRUE(lone.was_sent("7E4#17FF010000000000"));
  lone.run(200ms);
  EXPECT_EQ(lone.late_answer(), 0u);
  EXPECT_EQ(lone.node.user_position(lone.now, 0) % kOneCount, 0);
}

TEST_F(LatchTest, AFaultThatIsToldAgainIsCountedAndStopsNobodyAnew) {
  lone.node.on_drive_fault(lone.now, 0, emcy::kOverCurrent);
  lone.run(10ms);
  EXPECT_TRUE(lone.stopped());
  lone.clear_stop();
  ASSERT_FALSE(lone.stopped());
  lone.node.on_drive_fault(lone.now, 0, emcy::kShortCircuit);
  lone.run(10ms);
  EXPECT_FALSE(lone.stopped()) << "it is without power since the first";
  EXPECT_EQ(lone.counter(NodeCounter::kDriveFaults), 2);
  EXPECT_EQ(lone.read(0x603F, 0), emcy::kOverCurrent);
}

TEST_F(LatchTest, TroubleOfAnAxisIsToldOnceUntilItIsOver) {
  for (int times = 1; times <= 2; ++times) {
    for (int again = 0; again < 3; ++again) {
      lone.node.on_axis_trouble(lone.now, 1, emcy::kEncoder);
      lone.run(10ms);
    }
    EXPECT_TRUE(lone.stopped()) << times;
    EXPECT_EQ(lone.told(emcy::kEncoder), times);
    EXPECT_EQ(lone.counter(NodeCounter::kDriveFaults), times);
    lone.clear_stop();
    lone.node.on_axis_trouble(lone.now, 1, emcy::kEncoder);
    lone.run(10ms);
    EXPECT_FALSE(lone.stopped()) << "it lasts: who has cleared the stop knows of it";
    EXPECT_NE(lone.read(0x1001, 0), 0);
    lone.node.on_axis_trouble_gone(emcy::kEncoder);
    EXPECT_EQ(lone.read(0x1001, 0), 0);
  }
}

TEST_F(LatchTest, ACommandThatComesTwiceIsOne) {
  lone.rate(1);
  const CanFrame command =
      encode(RateCommand{.counter = 9, .full_ramp_2ms = 1, .start = Bench::whole_us(lone.now + 5ms)});
  lone.send(command);
  lone.send(command);
  lone.run(50ms);
  EXPECT_EQ(lone.counter(NodeCounter::kDuplicateFrames), 1);
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.node.path_rate_q32(lone.now), 0u);
}

/// A master that is lost: 1029h says what becomes of the state.
class LostMaster : public LatchTest, public testing::WithParamInterface<std::pair<int, NmtState>> {};

TEST_P(LostMaster, StopsAllAndTheNodeGoesToTheStateThatItIsToldTo) {
  ASSERT_EQ(lone.write(0x1029, 1, 1, GetParam().first), 0u);
  ASSERT_EQ(lone.write(0x1016, 1, 4, 0x7F'0032), 0u);
  lone.run(200ms);
  EXPECT_FALSE(lone.stopped()) << "one that was never heard is not lost";
  lone.send("77F#05");
  lone.run(100ms);
  EXPECT_TRUE(lone.stopped());
  EXPECT_EQ(lone.told(emcy::kHeartbeat), 1);
  EXPECT_EQ(lone.node.nmt_state(), GetParam().second);
  const std::size_t before = lone.seen.size();
  lone.send("000#0101");
  lone.send("77F#05");
  lone.run(20ms);
  lone.clear_stop();
  EXPECT_FALSE(lone.stopped());
  EXPECT_GT(lone.seen.size(), before);
}
INSTANTIATE_TEST_SUITE_P(ErrorBehaviour, LostMaster,
                         testing::Values(std::pair{0, NmtState::kPreOperational},
                                         std::pair{1, NmtState::kOperational},
                                         std::pair{2, NmtState::kStopped}));

TEST(NodeLatch, AMasterThatIsLostWhileNothingMovesStopsNobodyWithoutAGateway) {
  Lone lone;
  ASSERT_EQ(lone.write(0x1016, 1, 4, 0x7F'0032), 0u);
  lone.send("77F#05");
  lone.wait(100ms);
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.told(emcy::kHeartbeat), 1);
  EXPECT_NE(lone.read(0x1001, 0), 0);
  lone.send("77F#05");
  EXPECT_EQ(lone.read(0x1001, 0), 0) << "it is back";
  lone.start_move();
  lone.wait(100ms);
  EXPECT_TRUE(lone.stopped()) << "what moves stops";
  EXPECT_FALSE(lone.node.moving(lone.now));
}

TEST(NodeLatch, WithoutAGatewayAFaultResetAloneLiftsTheStop) {
  Lone lone;
  ASSERT_EQ(lone.write(0x2130, 7, 1, 7), 0u);
  lone.power();
  lone.node.on_switch(lone.now, 6, true);
  lone.wait(50ms);
  ASSERT_TRUE(lone.stopped());
  lone.control(0x87);
  EXPECT_TRUE(lone.stopped()) << "pressed";
  lone.node.on_switch(lone.now, 6, false);
  lone.wait(10ms);
  lone.control(0x87);
  for (const int word : {0x07, 0x0F, 0x07}) lone.control(word);
  EXPECT_TRUE(lone.stopped()) << "no edge of the reset's bit";
  lone.control(0x87);
  EXPECT_FALSE(lone.stopped());
}

TEST(NodeLatch, HomingThatFailsLetsTheOtherAxisGoOnWithoutAGateway) {
  Lone lone;
  ASSERT_EQ(lone.write(0x2140, 9, 4, 200), 0u);
  ASSERT_EQ(lone.write(0x6098, 0, 1, 19), 0u);
  ASSERT_EQ(lone.write(0x6060, 0, 1, 6), 0u);
  lone.power();
  lone.start_move(1);
  lone.control(0x0F);
  for (int times = 1; times <= 2; ++times) {
    lone.control(0x1F);
    lone.wait(200ms);
    EXPECT_EQ(lone.read(0x6041, 0) & 0x2000, 0x2000) << "its error";
    EXPECT_EQ(lone.told(node_emcy::kHoming), times);
    EXPECT_EQ(lone.counter(NodeCounter::kHomingErrors), times);
    EXPECT_FALSE(lone.stopped());
    EXPECT_TRUE(lone.node.moving(lone.now)) << "the other one";
    lone.control(0x0F);
  }
}

}  // namespace
}  // namespace kinebus::testing_bench
