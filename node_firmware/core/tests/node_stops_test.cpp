// The stops that three nodes with different crystals make together.

#include "node_firmware/core/tests/stream_bench.hpp"

namespace kinebus::testing_bench {
namespace {

TEST_F(StreamTest, LostSyncStopsAllFromTheSameInstant) {
  move_through_wave(8, 150ms);
  bench.stop_sync();
  watch(600ms);
  expect_stopped_together();
  EXPECT_EQ(bench.read(1, 0x2120, 5), 1);
}

TEST_F(StreamTest, OneNodeThatAloneHearsNoSyncStopsTheOthersToo) {
  move_through_wave(8, 100ms);
  bench.lose = [](std::size_t node, const CanFrame& frame) { return node == 2 && frame.id == 0x080; };
  watch(450ms);
  expect_stopped_together();
}

TEST_F(StreamTest, AnEmergencyStopInputStopsAllAndCannotBeClearedWhilePressed) {
  bench.write(2, 0x2130, 7, 1, 7);
  move_through_wave(6, 200ms);
  bench.node(1).on_switch(bench.local(1), 6, true);
  watch(150ms);
  expect_stopped_together();
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_EQ(bench.node(i).path().counters().late_stops, 0u);
  bench.command(RateCommand::Kind::kClear);
  bench.run(20ms);
  EXPECT_TRUE(bench.node(1).path().stop_latched());
  // The others were cleared; their motion still waits for the one that was not.
  bench.node(1).on_switch(bench.local(1), 6, false);
  bench.run(20ms);
  bench.command(RateCommand::Kind::kClear);
  bench.run(50ms);
  bench.rate(1.0);
  watch(600ms);
  expect_at_feeds_end();
}

TEST_F(StreamTest, AGatewayWithoutHeartbeatIsAnsweredByAStopOfAll) {
  for (std::uint8_t id = 1; id <= kNodes; ++id) bench.write(id, 0x1016, 1, 4, 0x7F0000 | (300 + id));
  bench.send("77F#05");
  move_through_wave(8, 600ms);
  expect_stopped_together();
  EXPECT_TRUE(bench.was_seen(0x081));
  EXPECT_EQ(get_u16_le(bench.last(0x081)->data), 0x8130);
}

TEST_F(StreamTest, AFaultOfOneAxisStopsAllOthersOnThePath) {
  move_through_wave(6, 200ms);
  bench.node(0).on_drive_fault(bench.local(0), 1, 0x2310);
  watch(150ms);
  EXPECT_TRUE(all_rest());
  EXPECT_LE(skew_us(), kSkewUs);
  EXPECT_FALSE(bench.node(0).drive(1).power);
  EXPECT_TRUE(bench.node(0).drive(0).power);
  EXPECT_TRUE(bench.node(2).drive(0).power);
  // What is queued for the axis without power is worth nothing: resuming stops again, at once.
  bench.command(RateCommand::Kind::kClear);
  bench.run(20ms);
  bench.rate(1.0);
  bench.run(200ms);
  EXPECT_TRUE(all_rest());
}

TEST_F(StreamTest, ACarriageThatFindsNoSwitchStopsThoseThatHomeWithIt) {
  bench.plant_on = false;
  for (const std::uint8_t id : {std::uint8_t{1}, std::uint8_t{3}}) {
    bench.write(id, 0x2140, 9, 4, id == 1 ? 20'000 : 400'000);
    bench.write(id, 0x6098, 0, 1, 20);
    bench.enable(id, 0, 6);
  }
  for (const std::uint8_t id : {std::uint8_t{1}, std::uint8_t{3}}) bench.write(id, 0x6040, 0, 2, 0x1F);
  bench.run(3s);
  EXPECT_EQ(bench.statusword(1, 0) & 0x3400, 0x2400) << "its error";
  const std::int64_t rests = bench.position(2, 0);
  EXPECT_GT(std::abs(rests), from_counts(10'000)) << "it homed, too";
  EXPECT_LT(std::abs(rests), from_counts(60'000)) << "and ends with the first";
  bench.run(500ms);
  EXPECT_EQ(bench.position(2, 0), rests);
  EXPECT_TRUE(bench.node(2).drive(0).power);
}

TEST_F(StreamTest, QuickStopOfOneAxisIsAStopOfAll) {
  move_through_wave(6, 200ms);
  CanFrame quick{.id = 0x201, .length = 6};
  quick.data = {0x0B, 0x00, 0x0F, 0x00, 7, 7};
  bench.send(quick);
  watch(150ms);
  expect_stopped_together();
  EXPECT_EQ(bench.statusword(1, 0) & 0x6F, 0x07);
  EXPECT_EQ(bench.statusword(1, 1) & 0x6F, 0x27);
}

TEST_F(StreamTest, AStopByTheGatewayIsCleanAndTheQueueCanBeDropped) {
  move_through_wave(6, 200ms);
  bench.command(RateCommand::Kind::kStop);
  watch(150ms);
  expect_stopped_together();
  for (std::uint8_t id = 1; id <= kNodes; ++id) bench.write(id, 0x60C4, 6, 1, 0);
  watch(50ms);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_TRUE(bench.node(i).path().stream().idle());
    EXPECT_EQ(bench.node(i).user_position(bench.local(i), 0) % kOneCount, 0);
    feeds[i].sequence = 0;
    for (std::size_t axis = 0; axis < 2; ++axis)
      feeds[i].state[axis] = {bench.node(i).user_position(bench.local(i), static_cast<int>(axis)), 0};
  }
  bench.command(RateCommand::Kind::kClear);
  bench.run(20ms);
  start_all(2000);
  wave(1);
  end_all();
  bench.run(50ms);
  bench.rate(1.0);
  watch(300ms);
  expect_at_feeds_end();
}

TEST_F(StreamTest, AnOverrunIsToldAtOnceAndNamesAStopThatLiesAhead) {
  start_all(1000);
  wave(8);
  end_all();
  bench.run(50ms);
  bench.rate(1.0, 5ms, 1);
  watch(50ms);
  // From here on node 2 hears nothing, and its next deadline is far.
  bench.lose = [](std::size_t node, const CanFrame&) { return node == 1; };
  bench.run(8ms);
  const std::size_t before = bench.seen.size();
  bench.node(1).on_receive_overrun(bench.local(1), 3);
  const auto start = bench.node(1).path().stop_start();
  ASSERT_TRUE(start);
  EXPECT_GT(*start, bench.local(1) + 1ms);
  bench.run(10us);
  bench.run(1ms);
  EXPECT_TRUE(bench.was_seen(0x082, before));
  bench.lose = {};
  watch(200ms);
  EXPECT_TRUE(all_rest());
}

}  // namespace
}  // namespace kinebus::testing_bench
