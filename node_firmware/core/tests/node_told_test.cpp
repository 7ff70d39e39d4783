// What a node counts of what it hears, and when it tells how its stream is.

#include "node_firmware/core/tests/lone_bench.hpp"
#include "protocol/canopen/alarm_codes.hpp"

namespace kinebus::testing_bench {
namespace {

using Kind = RateCommand::Kind;

struct ToldTest : LoneStreamTest {
  /// A command that is heard `late` after the instant that it names.
  void hear(Kind kind, BusTime late, double rate = 1) {
    number = static_cast<std::uint8_t>((number + 1) & 0xF);
    lone.send(encode(RateCommand{.kind = kind,
                                 .counter = number,
                                 .rate_q15 = static_cast<std::uint16_t>(std::lround(rate * 32768)),
                                 .full_ramp_2ms = 20,
                                 .start = Bench::whole_us(lone.now + 1ms - late)}));
  }
  void hear_stop_of_peer(BusTime start) {
    CanFrame frame{.id = 0x085, .length = 8};
    put_u16_le(frame.data, node_emcy::kEmergencyStop);
    frame.data[2] = 0x81;
    const auto rest = encode(StopRequest{StopReason::kEmergencyStopInput, 1, start});
    std::copy(rest.begin(), rest.end(), frame.data.begin() + 3);
    lone.send(frame);
  }
  std::int64_t late_rates() { return lone.counter(NodeCounter::kLateRateCommands); }
  std::int64_t late_stops() { return lone.counter(NodeCounter::kLateStops); }
  std::int64_t stops() { return lone.counter(NodeCounter::kCoordinatedStops); }
  /// Statuses of the stream in `span`.
  std::size_t statuses(BusTime span) {
    lone.seen.clear();
    lone.run(span);
    return static_cast<std::size_t>(
        std::ranges::count_if(lone.seen, [](const CanFrame& frame) { return frame.id == 0x281; }));
  }
  std::uint8_t number = 8, sync_number = 120;
};

TEST_F(ToldTest, ARateThatCameInTimeIsNotLateAndEveryOtherIs) {
  hear(Kind::kRate, -5ms);
  lone.run(100ms);
  EXPECT_EQ(late_rates(), 0);
  hear(Kind::kRate, 2us, 0.5);  // a step that no motor feels
  EXPECT_EQ(late_rates(), 1);
  lone.run(100ms);
  hear(Kind::kRate, 1ms, 1);  // caught up
  EXPECT_EQ(late_rates(), 2);
  lone.run(100ms);
  EXPECT_FALSE(lone.stopped());
  hear(Kind::kRate, 60ms, 0.5);  // refused
  EXPECT_EQ(late_rates(), 3);
  EXPECT_EQ(late_stops(), 0);
  lone.run(100ms);
  EXPECT_TRUE(lone.stopped());
  EXPECT_EQ(lone.told(node_emcy::kCommand), 1);
}

TEST_F(ToldTest, AStopThatCameInTimeIsNotLateAndEveryOtherIs) {
  const BusTime lates[] = {-5ms, 2us, 4ms, 60ms};
  for (std::size_t i = 0; i < std::size(lates); ++i) {
    lone.rate(1);
    hear(Kind::kStop, lates[i]);
    EXPECT_EQ(late_stops(), static_cast<std::int64_t>(i)) << lates[i].count();
    EXPECT_EQ(stops(), static_cast<std::int64_t>(i + 1));
    lone.run(200ms);
    EXPECT_TRUE(lone.stopped());
    EXPECT_EQ(lone.node.path_rate_q32(lone.now), 0u);
    lone.clear_stop();
    EXPECT_FALSE(lone.stopped());
  }
  EXPECT_EQ(late_rates(), 0);
}

TEST_F(ToldTest, AStopOfAnotherNodeCountsOnceAndLateWhereItIs) {
  lone.rate(1);
  BusTime start = Bench::whole_us(lone.now + 2ms);
  hear_stop_of_peer(start);
  EXPECT_EQ(stops(), 1);
  hear_stop_of_peer(start);
  hear_stop_of_peer(start + 1ms);
  EXPECT_EQ(stops(), 1) << "all tell of one";
  EXPECT_EQ(late_stops(), 0);
  lone.run(200ms);
  lone.clear_stop();
  lone.rate(1);
  hear_stop_of_peer(Bench::whole_us(lone.now - 3ms));
  EXPECT_EQ(stops(), 2);
  EXPECT_EQ(late_stops(), 1);
}

TEST_F(ToldTest, AFrameThatOnlyLooksLikeAStopIsNone) {
  lone.rate(1);
  CanFrame frame{.id = 0x085, .length = 8};
  put_u16_le(frame.data, node_emcy::kEmergencyStop);
  lone.send(frame);
  lone.run(20ms);
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(stops(), 0);
}

TEST_F(ToldTest, WithNothingQueuedNothingIsTold) {
  follow();
  lone.run(1s);
  EXPECT_EQ(statuses(3s), 0u);
}

TEST_F(ToldTest, WhileRecordsWaitTheirNumberIsToldEachHalfSecond) {
  follow();
  queue({600'000, -600'000});
  EXPECT_GE(statuses(200ms), 1u) << "they have come";
  EXPECT_NEAR(static_cast<double>(statuses(3s)), 6, 1);
}

TEST_F(ToldTest, WhileItRunsItIsToldEachTenthOfASecond) {
  follow();
  std::vector<std::int32_t> slow;
  for (int i = 0; i < 60; ++i) slow.push_back(i % 2 == 0 ? 100'000 : -100'000);
  queue(slow);
  lone.rate(1);
  EXPECT_NEAR(static_cast<double>(statuses(1s)), 10, 2);
}

TEST_F(ToldTest, ManyShortRecordsAreToldOfAsTheyAreExecuted) {
  follow();
  record({.control = SegmentControl::kStart,
          .start_units = lone.node.path_time(lone.now).count() / kPathTicksPerUnit + 100});
  for (int i = 0; i < 100; ++i)
    record({.duration = 64, .acceleration = {i % 2 == 0 ? 100'000 : -100'000, 0}});
  record({.control = SegmentControl::kEnd});
  // 102 ms: each 32 of them, and the end.
  lone.seen.clear();
  lone.rate(1);
  lone.run(90ms);
  std::vector<std::uint8_t> rooms;
  for (const CanFrame& frame : lone.seen)
    if (frame.id == 0x281) rooms.push_back(decode_stream_status(get_u64_le(frame.data)).free_records);
  ASSERT_GE(rooms.size(), 3u);
  for (std::size_t i = 1; i < rooms.size(); ++i) EXPECT_LE(rooms[i] - rooms[i - 1], 60) << i;
}

TEST_F(ToldTest, AChangeOfItsFlagsIsToldAtOnce) {
  follow();
  lone.run(600ms);
  lone.seen.clear();
  hear(Kind::kStop, -2ms);
  lone.wait(5ms);
  const auto status =
      std::ranges::find_if(lone.seen, [](const CanFrame& frame) { return frame.id == 0x281; });
  ASSERT_NE(status, lone.seen.end());
  EXPECT_TRUE(decode_stream_status(get_u64_le(status->data)).flags & StreamStatus::kStopped);
}

TEST_F(ToldTest, APulseOfASwitchIsShownAlsoWhereItIsOverBeforeAFrameGoesOut) {
  lone.run(100ms);
  lone.seen.clear();
  lone.now += 1ms;
  lone.node.on_switch(lone.now, 3, true);
  lone.node.on_switch(lone.now + 2ms, 3, false);
  lone.now += 5ms;
  lone.node.on_time(lone.now);
  lone.run(200ms);
  std::vector<int> shown;
  for (const CanFrame& frame : lone.seen)
    if (frame.id == 0x181) shown.push_back((frame.data[6] >> 3) & 1);
  EXPECT_EQ(shown, (std::vector{1, 0}));
}

TEST_F(ToldTest, AClockThatBecomesUnsureIsCountedOncePerTime) {
  const auto noisy = [&](int syncs, BusTime noise) {
    for (int i = 0; i < syncs; ++i) {
      lone.wait(5ms);
      sync_number = static_cast<std::uint8_t>(sync_number % 240 + 1);
      const BusTime at = lone.now;
      lone.node.on_frame(at, CanFrame::make(0x080, {sync_number}));
      lone.send(encode(SyncStamp{
          .counter = sync_number, .epoch = 1, .time = at + (i % 2 == 0 ? noise : BusTime{0} - noise)}));
    }
  };
  const auto counted = [&] { return lone.counter(NodeCounter::kClockOutOfBound); };
  EXPECT_EQ(counted(), 0);
  noisy(200, 60us);
  const std::int64_t first = counted();
  EXPECT_GE(first, 1);
  EXPECT_LE(first, 5) << "not each of 200 stamps";
  noisy(600, 0us);  // until the window of 512 has forgotten
  const std::int64_t quiet = counted();
  noisy(2000, 0us);
  EXPECT_EQ(counted(), quiet);
  noisy(200, 60us);
  EXPECT_GT(counted(), quiet);
}

}  // namespace
}  // namespace kinebus::testing_bench
