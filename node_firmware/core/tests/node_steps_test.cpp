// Orders of events in which an axis once jumped, or would: whatever comes, position goes on from where it is.

#include "node_firmware/core/tests/node_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr std::uint8_t kNodeId = 1;

struct StepsTest : testing::Test {
  StepsTest()
      : bench(
            {{.id = kNodeId, .plant = {AxisPlantOptions{.switch_input = 1, .switch_counts = 100'000}, {}}}}) {
  }

  double counts(int axis = 0) { return std::ldexp(static_cast<double>(bench.position(0, axis)), -32); }
  void control(int word) { bench.write(kNodeId, 0x6040, 0, 2, word); }
  /// Lets time pass in half milliseconds. No step of position, and of velocity no more than 1000 counts/s
  /// beyond what 1280000 counts/s^2 give in that time.
  void watch(BusTime span, double most_change = 1640) {
    double last = counts(), last_speed = 0;
    bool first = true;
    bench.run(span, 500us, [&] {
      const double here = counts();
      const double speed = (here - last) * 2000;
      EXPECT_LE(std::abs(speed), 600'000) << "at " << bench.now.count() << " ns";
      if (!first) {
        EXPECT_LE(std::abs(speed - last_speed), most_change) << "at " << bench.now.count() << " ns";
      }
      first = false;
      last = here;
      last_speed = speed;
    });
  }
  /// Another node asks all to stop.
  void peer_stop() {
    const StopRequest stop{.reason = StopReason::kCommand, .start = Bench::whole_us(bench.now + 1500us)};
    bench.send(encode(Emergency{2, 0x1000, 0x01, encode(stop)}));
  }
  Bench bench;
};

TEST_F(StepsTest, ASetPointThatWaitsBehindAHaltIsDroppedByAStopOfAll) {
  bench.enable(kNodeId, 0, 1);
  for (const int to : {60'000, 90'000}) {
    bench.write(kNodeId, 0x607A, 0, 4, to);
    control(0x0F);
    control(0x1F);
  }
  control(0x10F);
  watch(500ms);
  peer_stop();
  watch(300ms);
  const double rests = counts();
  control(0x0F);
  watch(300ms);
  control(0x8F);
  control(0x0F);
  watch(300ms);
  EXPECT_EQ(counts(), rests);
}

TEST_F(StepsTest, AWaitingSetPointIsDroppedByAChangeOfMode) {
  bench.enable(kNodeId, 0, 1);
  for (const int to : {60'000, 90'000}) {
    bench.write(kNodeId, 0x607A, 0, 4, to);
    control(0x0F);
    control(0x1F);
  }
  bench.run(200ms);
  bench.write(kNodeId, 0x6060, 0, 1, 6);
  watch(1s);
  EXPECT_EQ(bench.read(kNodeId, 0x6061, 0), 6);
  EXPECT_LT(counts(), 59'000);
}

TEST_F(StepsTest, HomingThatBeginsAgainWhileItStillBrakesGoesOnFromItsSpeed) {
  bench.write(kNodeId, 0x6098, 0, 1, 20);
  bench.enable(kNodeId, 0, 6);
  control(0x1F);
  watch(400ms);
  control(0x0F);
  bench.run(5ms);
  control(0x1F);
  watch(3s);
  bench.run(10s);
  EXPECT_EQ(bench.statusword(kNodeId, 0) & 0x3400, 0x1400);
}

/// Of velocity in half a millisecond, along send_stream(): 5.6e6 counts/s^2.
constexpr double kStreamChange = 4500;

/// Records that move axis A: up to 110'000 counts/s within 20 ms, and back.
void send_stream(Bench& bench, std::int64_t start_units) {
  std::uint8_t sequence = 0;
  const auto send = [&](const Segment& segment) {
    CanFrame frame{.id = 0x401, .length = 8};
    put_u64_le(frame.data, encode(segment));
    bench.send(frame);
  };
  send({.sequence = sequence++, .control = SegmentControl::kStart, .start_units = start_units});
  for (int i = 0; i < 8; ++i)
    for (const int sign : {1, -1, -1, 1})
      send({.sequence = sequence++, .duration = 1250, .acceleration = {sign * 600'000, 0}});
  send({.sequence = sequence++, .control = SegmentControl::kEnd});
}

/// Both axes follow it at full rate from here on.
void run_stream(Bench& bench) {
  bench.bring_up();
  for (int axis = 0; axis < 2; ++axis) bench.enable(kNodeId, axis, 7);
  send_stream(bench, bench.node().path_time(bench.local()).count() / kPathTicksPerUnit + 100);
  bench.run(20ms);
  bench.rate(1.0);
}

TEST_F(StepsTest, WithoutBusTimeNoStreamMoves) {
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  for (int axis = 0; axis < 2; ++axis) bench.enable(kNodeId, axis, 7);
  const std::size_t before = bench.seen.size();
  send_stream(bench, 100);
  bench.rate(1.0);
  bench.run(20ms);
  EXPECT_TRUE(bench.was_seen(0x081, before));
  // The first stamps set the estimate from nothing to an hour.
  bench.start_epoch(1, 1h);
  bench.start_sync(5ms);
  watch(1s);
  EXPECT_EQ(counts(), 0);
}

TEST_F(StepsTest, AnAxisOnTheStreamStaysOnItWhenTheLineModeIsAskedForInMotion) {
  run_stream(bench);
  bench.run(200ms);
  bench.write(kNodeId, 0x60C0, 0, 2, 0);
  control(0x1F);
  watch(300ms, kStreamChange);
  // The waves come back to their start, on the stream alone.
  bench.run(700ms);
  EXPECT_EQ(counts(), 0);
}

TEST_F(StepsTest, WithoutSyncAnAxisThatMovesByItselfStopsToo) {
  bench.bring_up();
  bench.enable(kNodeId, 0, 1);
  bench.write(kNodeId, 0x607A, 0, 4, 300'000);
  control(0x0F);
  control(0x1F);
  bench.run(50ms);
  ASSERT_TRUE(bench.node().moving(bench.local()));
  bench.stop_sync();
  bench.run(400ms);
  EXPECT_TRUE(bench.node().path().stop_latched());
  EXPECT_FALSE(bench.node().moving(bench.local()));
}

TEST_F(StepsTest, ARateCommandThatComesLateCatchesUpWithoutAStep) {
  run_stream(bench);
  bench.run(250ms);
  const double before = counts();
  bench.rate(0.0, -4500us, 25);
  bench.run(131us);  // the frame has just arrived
  EXPECT_NEAR(counts(), before, 120'000 * 140e-6);
  watch(200ms, kStreamChange);
}

TEST_F(StepsTest, ARateCommandThatComesTooLateIsVoidAndStopsAll) {
  run_stream(bench);
  bench.run(250ms);
  const std::size_t before = bench.seen.size();
  bench.rate(0.5, -30ms, 25);
  watch(3ms, kStreamChange);
  EXPECT_TRUE(bench.was_seen(0x081, before));
  watch(200ms, kStreamChange);
  EXPECT_EQ(bench.node().path_rate_q32(bench.local()), 0u);
}

TEST_F(StepsTest, ARateCommandThatAStopHoldsBackIsAnsweredByAStopOfAll) {
  bench.bring_up();
  for (int axis = 0; axis < 2; ++axis) bench.enable(kNodeId, axis, 7);
  peer_stop();
  bench.run(200ms);
  const std::size_t before = bench.seen.size();
  bench.rate(1.0);  // the clear command before it was lost
  bench.run(10ms);
  EXPECT_TRUE(bench.was_seen(0x081, before));
}

}  // namespace
}  // namespace kinebus::testing_bench
