// The clock of the loop by given readings of the monotonic clock.

#include "gateway/io/loop_clock.hpp"

#include <gtest/gtest.h>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

TEST(LoopClock, OfRealNodesIsTheMonotonicClock) {
  LoopClock clock(LoopClock::Kind::kMonotonic);
  EXPECT_EQ(clock.read(10s), LocalTime{10s});
  EXPECT_EQ(clock.read(13s), LocalTime{13s});
  EXPECT_EQ(clock.woken(13s, 14s, 20s), LocalTime{20s});
  EXPECT_EQ(clock.behind(), LocalTime{0});
}

TEST(LoopClock, OfItsOwnStandsWhileTheProcessIsNotRun) {
  LoopClock clock(LoopClock::Kind::kOwn);
  EXPECT_EQ(clock.read(10s), LocalTime{10s});
  EXPECT_EQ(clock.read(10s + 1ms), LocalTime{10s + 1ms});
  // Stopped for 3 s within a turn: one longest step has passed.
  EXPECT_EQ(clock.read(13s + 1ms), LocalTime{10s + 1ms} + LoopClock::kLongestStep);
  EXPECT_EQ(clock.behind(), LocalTime{3s} - LoopClock::kLongestStep);
  EXPECT_EQ(clock.monotonic_at(clock.read(13s + 1ms)), LocalTime{13s + 1ms});
}

TEST(LoopClock, OfItsOwnRunsThroughWantedSleepAndStandsAfterIt) {
  LoopClock clock(LoopClock::Kind::kOwn);
  const LocalTime from = clock.read(10s);
  // Woken early by a client, and at the deadline: all of it was wanted.
  EXPECT_EQ(clock.woken(from, 12s, 11s), LocalTime{11s});
  EXPECT_EQ(clock.woken(11s, 12s, 12s), LocalTime{12s});
  // Woken 700 ms after the deadline.
  EXPECT_EQ(clock.woken(12s, 12s + 10ms, 12s + 710ms), LocalTime{12s + 10ms} + LoopClock::kLongestStep);
  // A deadline that has passed (0: at once) is no wanted sleep.
  const LocalTime now = clock.read(12s + 710ms);
  EXPECT_EQ(clock.woken(now, LocalTime{0}, 15s), now + LoopClock::kLongestStep);
  EXPECT_EQ(clock.monotonic_at(LocalTime::max()), LocalTime::max());
}

}  // namespace
}  // namespace kinebus
