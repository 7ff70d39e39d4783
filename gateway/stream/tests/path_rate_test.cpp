#include "gateway/stream/path_rate.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

RateCommand sent(PathRate& rate, BusTime now) {
  const auto frame = rate.next_frame(now);
  EXPECT_TRUE(frame);
  const auto command = decode_rate_command(frame.value_or(CanFrame{}), now);
  EXPECT_TRUE(command);
  return command.value_or(RateCommand{});
}

TEST(PathRate, NodesThatHearTheCommandsHaveTheSamePathTime) {
  PathRate rate;
  PathClock node(
      {.rewind = 2s, .most_step = PathTime::max()});  // remembers as long, to be compared afterwards
  const auto relay = [&](BusTime now) { node.apply(sent(rate, now), now); };
  rate.request(1, 100ms, 1s);
  relay(1s + 700us);
  rate.request(0.3, 200ms, 3s);
  relay(3s + 100us);
  rate.stop(4s);
  relay(4s + 300us);
  for (BusTime t = 1s; t < 6s; t += 7ms) ASSERT_EQ(rate.tau(t), node.tau(t));
  EXPECT_TRUE(rate.at_rest(5s));
  EXPECT_TRUE(rate.stop_latched());
}

TEST(PathRate, AskingForTheSameRateSendsNothing) {
  PathRate rate;
  rate.request(0, 100ms, 1s);
  EXPECT_FALSE(rate.next_frame(1s));
  rate.request(1, 100ms, 1s);
  EXPECT_TRUE(rate.next_frame(1s));
  rate.request(1, 100ms, 2s);
  EXPECT_FALSE(rate.next_frame(1s));
}

TEST(PathRate, LatchedStopIgnoresRatesUntilCleared) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  rate.stop(2s);
  rate.next_frame(1s);
  rate.next_frame(1s);
  rate.request(1, 2ms, 3s);
  EXPECT_FALSE(rate.next_frame(1s));
  rate.clear(3s);
  EXPECT_EQ(sent(rate, 3s).kind, RateCommand::Kind::kClear);
  rate.on_time(3s + 10ms);
  rate.request(1, 2ms, 3s + 10ms);
  EXPECT_TRUE(rate.next_frame(1s));
  EXPECT_FALSE(rate.at_rest(4s));
}

TEST(PathRate, WhatWasAskedForBeforeAClearMayBeAskedForAgain) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  rate.clear(1s + 1ms);
  EXPECT_EQ(rate.target(), 0);
  rate.request(1, 2ms, 1s + 2ms);
  EXPECT_EQ(rate.counters().commands, 3u);
}

TEST(PathRate, StopOvertakesARateThatIsStillAhead) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  const BusTime first = sent(rate, 1s).start;
  rate.stop(1s + 1ms);
  const RateCommand stop = sent(rate, 1s + 1ms);
  EXPECT_EQ(stop.kind, RateCommand::Kind::kStop);
  EXPECT_GE(stop.start, BusTime{1s + 1ms});
  EXPECT_LE(stop.start, first + 5ms);
}

// A node that heard of the stop would answer a rate behind it with a stop of its own, each time.
TEST(PathRate, ARateBehindAStopIsNotRepeated) {
  for (const bool by_node : {false, true}) {
    for (const bool first_was_out : {false, true}) {
      PathRate rate;
      rate.request(1, 2ms, 1s);
      if (first_was_out) {
        EXPECT_EQ(sent(rate, 1s).start, 1s + 50ms);
      }
      if (by_node)
        rate.on_stop_request({StopReason::kStarved, 0, 1s + 6ms}, 1s + 1ms);
      else
        rate.stop(1s + 1ms);
      int stops = 0;
      for (BusTime t = 1s + 1ms; t < 1s + 60ms; t += 100us)
        for (auto frame = rate.next_frame(t); frame; frame = rate.next_frame(t)) {
          rate.on_frame_sent(t, *frame);
          EXPECT_EQ(decode_rate_command(*frame, t)->kind, RateCommand::Kind::kStop);
          ++stops;
        }
      EXPECT_EQ(stops, 1);
      for (auto frame = rate.next_repeat(2s); frame; frame = rate.next_repeat(2s), ++stops)
        EXPECT_EQ(decode_rate_command(*frame, 1s)->kind, RateCommand::Kind::kStop);
      EXPECT_EQ(stops, 8);
      EXPECT_TRUE(rate.all_sent());
    }
  }
  // One that begins before the stop is what the stop begins from.
  PathRate rate;
  rate.request(1, 200ms, 1s);
  for (BusTime t = 1s; t < 1s + 100ms; t += 1ms)
    while (rate.next_frame(t) || rate.next_repeat(t)) {
    }
  rate.request(0.5, 200ms, 2s);
  rate.stop(2s + 1ms);
  EXPECT_EQ(sent(rate, 2s + 1ms).kind, RateCommand::Kind::kRate);
  EXPECT_EQ(sent(rate, 2s + 1ms).kind, RateCommand::Kind::kStop);
}

TEST(PathRate, NodesStopRequestStopsTheGatewaysClockToo) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  rate.on_stop_request({StopReason::kStarved, 0, 2s}, 2s);
  EXPECT_TRUE(rate.at_rest(2s + 150ms));
  EXPECT_TRUE(rate.stop_latched());
}

TEST(PathRate, EveryCommandGoesOutEightTimesBeforeItsStart) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  rate.next_frame(1s);
  while (rate.next_repeat(1500ms)) {
  }
  rate.request(0, 200ms, 2s);
  const RateCommand hold = sent(rate, 2s);
  int copies = 1;
  for (BusTime now = 2s; now < hold.start; now += 100us)
    if (const auto frame = rate.next_repeat(now)) {
      EXPECT_EQ(decode_rate_command(*frame, now), hold);
      ++copies;
    }
  EXPECT_EQ(copies, 8);
  EXPECT_FALSE(rate.next_repeat(3s));
}

TEST(PathRate, AMotionFromRestIsNamedFartherAheadThanAHold) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  EXPECT_EQ(sent(rate, 1s).start, 1s + 50ms);
  rate.request(0, 200ms, 2s);
  EXPECT_EQ(sent(rate, 2s).start, 2s + 5ms);
}

TEST(PathRate, ASmoothRampThatIsTriedIsTheOneThatIsAskedForAndTakesTwiceItsTime) {
  PathRate rate;
  for (const double target : {1.0, 0.25}) {
    const BusTime now = target == 1 ? 1s : 3s, start = now + (target == 1 ? 50ms : 10ms);
    const double before = rate.target();
    const PathClock tried = rate.with_smooth(target, 300ms, now);
    EXPECT_EQ(rate.target(), before);
    EXPECT_FALSE(rate.is_target(target));
    rate.request_smooth(target, 300ms, now);
    EXPECT_TRUE(rate.is_target(target));
    const RateCommand command = sent(rate, now);
    EXPECT_EQ(command.kind, RateCommand::Kind::kSmooth);
    EXPECT_EQ(command.start, start);
    EXPECT_NEAR(rate.rate(start + 300ms), (before + target) / 2, 1e-4);
    EXPECT_LT(std::abs(rate.rate(start + 590ms) - target), 1e-3);
    EXPECT_EQ(rate.rate(start + 600ms), target);
    for (BusTime t = start; t < start + 700ms; t += 7ms) ASSERT_EQ(rate.tau(t), tried.tau(t));
  }
}

TEST(PathRate, ACommandIsSentWhenItWasOnTheBus) {
  PathRate rate;
  EXPECT_TRUE(rate.all_sent());
  rate.request(1, 2ms, 1s);
  const auto frame = rate.next_frame(1s);
  ASSERT_TRUE(frame);
  EXPECT_FALSE(rate.all_sent()) << "the bus may be blocked";
  rate.on_frame_sent(1s + 1ms, *frame);
  EXPECT_TRUE(rate.all_sent());
}

TEST(PathRate, AStopThatWaitedForTheBusNamesAStartThatLiesAhead) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  rate.next_frame(1s);
  rate.stop(2s);
  const RateCommand stop = sent(rate, 2s + 90ms);
  EXPECT_EQ(stop.kind, RateCommand::Kind::kStop);
  EXPECT_EQ(stop.start, 2s + 95ms);
  while (const auto frame = rate.next_repeat(2s + 95ms)) {
    const auto copy = decode_rate_command(*frame, 2s);
    ASSERT_TRUE(copy);
    EXPECT_NE(copy->start, 2s + 5ms);
  }
}

TEST(PathRate, FramesThatGoOutTooLateAreCounted) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  const auto frame = rate.next_frame(1s);
  ASSERT_TRUE(frame);
  rate.on_frame_sent(1s + 1ms, *frame);
  EXPECT_EQ(rate.counters().late, 0u);
  rate.on_frame_sent(1s + 60ms, *frame);
  EXPECT_EQ(rate.counters().late, 1u);
}

TEST(PathRate, CommandsAreNumberedInTurn) {
  PathRate rate;
  BusTime now = 1s;
  std::optional<std::uint8_t> last;
  for (int k = 0; k < 40; ++k, now += 1s) {
    if (k % 3 == 2)
      rate.on_stop_request({StopReason::kStarved, 0, now + 2ms}, now);
    else if (rate.stop_latched())
      rate.clear(now);
    else
      rate.request(k % 2 == 0 ? 1 : 0.5, 2ms, now);
    const RateCommand command = sent(rate, now);
    while (rate.next_repeat(now + 100ms)) {
    }
    if (last) {
      EXPECT_EQ(command.counter, (*last + 1) % 16) << k;
    }
    last = command.counter;
    EXPECT_FALSE(rate.next_frame(now));
  }
  EXPECT_GT(rate.counters().commands, 20u);
}

TEST(PathRate, CopiesOfTwoCommandsComeEachInItsTime) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  const RateCommand first = sent(rate, 1s);
  rate.request(0.5, 2ms, 1s + 1ms);
  const RateCommand second = sent(rate, 1s + 1ms);
  EXPECT_EQ(rate.counters().commands, 2u);
  int of_first = 0, of_second = 0;
  for (BusTime now = 1s; now < 1s + 10ms; now += 100us) {
    EXPECT_GE(rate.next_deadline(), now);
    while (const auto frame = rate.next_repeat(now)) {
      const auto command = decode_rate_command(*frame, now);
      ASSERT_TRUE(command == first || command == second);
      int& copies = command == first ? of_first : of_second;
      ++copies;
      EXPECT_EQ(now, (command == first ? 1s : 1s + 1ms) + copies * 600us);
    }
  }
  EXPECT_EQ(of_first, 7);
  EXPECT_EQ(of_second, 7);
  EXPECT_EQ(rate.next_deadline(), BusTime::max());
}

TEST(PathRate, WhereNoJointMovesThereIsNoHurry) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  sent(rate, 1s);
  rate.request(0.5, 2ms, 2s, false);
  EXPECT_EQ(sent(rate, 2s).start, 2s + 50ms);
}

TEST(PathRate, AfterAStopNothingIsAskedFor) {
  for (int way = 0; way < 3; ++way) {
    PathRate rate;
    rate.request(1, 2ms, 1s);
    sent(rate, 1s);
    if (way == 0) rate.stop(2s);
    if (way != 0) rate.on_stop_request({StopReason::kStarved, 0, 2s}, 2s);
    EXPECT_EQ(rate.target(), 0) << way;
    sent(rate, 2s);
    if (way != 2) continue;
    rate.clear(3s);
    EXPECT_EQ(rate.target(), 0);
    sent(rate, 3s);
    rate.on_time(3s + 10ms);
    rate.request(1, 2ms, 3s + 10ms);
    EXPECT_EQ(rate.target(), 1) << "the same rate anew";
    EXPECT_TRUE(rate.next_frame(3s + 10ms));
  }
}

TEST(PathRate, OneStopRequestHeardTwiceIsAnsweredOnce) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  sent(rate, 1s);
  rate.on_stop_request({StopReason::kStarved, 0, 2s}, 2s);
  EXPECT_EQ(sent(rate, 2s).start, 2s);
  rate.on_stop_request({StopReason::kStarved, 0, 2s}, 2s + 1ms);
  EXPECT_FALSE(rate.next_frame(2s + 1ms));
}

TEST(PathRate, OnlyAStopThatWaitedIsNamedAnew) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  EXPECT_EQ(sent(rate, 1s + 200ms).start, 1s + 50ms) << "a rate that is late is void";
  while (rate.next_repeat(2s)) {
  }
  rate.on_frame_sent(1s + 200ms, encode(RateCommand{}));
  rate.stop(2s);
  const auto frame = rate.next_frame(2s + 90ms);
  ASSERT_TRUE(frame);
  EXPECT_FALSE(rate.next_frame(2s + 90ms)) << "the late one does not go out, too";
  EXPECT_FALSE(rate.all_sent());
  rate.on_frame_sent(2s + 91ms, *frame);
  PathRate fresh;
  fresh.stop(2s);
  fresh.on_frame_sent(2s + 91ms, *fresh.next_frame(2s + 90ms));
  EXPECT_TRUE(fresh.all_sent()) << "nobody waits for the late one";
}

TEST(PathRate, OnlyItsOwnFramesAreLate) {
  PathRate rate;
  rate.request(1, 2ms, 1s);
  CanFrame frame = *rate.next_frame(1s);
  frame.id += 1;
  rate.on_frame_sent(3s, frame);
  EXPECT_EQ(rate.counters().late, 0u);
  EXPECT_FALSE(rate.all_sent());
}

}  // namespace
}  // namespace kinebus
