// When the gateway was away: the job goes on by itself only where nothing but that was the cause, and not for
// ever.

#include "gateway/machine/stall_recovery.hpp"

#include <gtest/gtest.h>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class StallRecoveryTest : public ::testing::Test {
 protected:
  StallRecoveryTest() { machine_.stop.after_stall = StopDescription::AfterStall::kGoOn; }
  /// Stopped at 10 s for want of SYNC, after a stall that ended then: what comes of it.
  bool goes_on(StallRecovery& stall, BusTime from = 10s) {
    stall.on_stall(from, 1s, say("a test"));
    stall.on_stop(from, true);
    return clears_and_goes_on(stall, from);
  }
  bool clears_and_goes_on(StallRecovery& stall, BusTime from) {
    if (stall.next(from + 2s, from, true) != StallRecovery::Step::kClear) return false;
    EXPECT_EQ(stall.next(from + 2s, from, true), StallRecovery::Step::kNone) << "each step once";
    const bool goes = stall.next(from + 3s, from + 2s, false) == StallRecovery::Step::kGoOn;
    EXPECT_EQ(stall.next(from + 3s, from + 2s, false), StallRecovery::Step::kNone) << "each step once";
    return goes;
  }
  MachineDescription machine_;
  EventQueue events_;
};

TEST_F(StallRecoveryTest, GoesOnByItselfOnlyWhereTheMachineFileSaysSo) {
  StallRecovery stall(machine_, events_);
  EXPECT_TRUE(goes_on(stall));
  machine_.stop.after_stall = StopDescription::AfterStall::kAsk;
  StallRecovery asks(machine_, events_);
  EXPECT_FALSE(goes_on(asks));
}

TEST_F(StallRecoveryTest, AStopThatHasAnotherCauseWaitsForAPerson) {
  StallRecovery never(machine_, events_);
  never.on_stop(10s, true);
  EXPECT_FALSE(clears_and_goes_on(never, 10s)) << "the gateway was not away";
  for (const BusTime later : {2s - 1ns, BusTime{2s}}) {
    StallRecovery stall(machine_, events_);
    stall.on_stall(10s, 1s, say("a test"));
    stall.on_stop(10s + later, true);
    EXPECT_EQ(clears_and_goes_on(stall, 10s + later), later < 2s);
  }
  StallRecovery fault(machine_, events_);
  fault.on_stall(10s, 1s, say("a test"));
  fault.on_stop(10s, false);
  EXPECT_FALSE(clears_and_goes_on(fault, 10s));
}

TEST_F(StallRecoveryTest, WhatElseGoesWrongInTheSameStopEndsIt) {
  StallRecovery worse(machine_, events_);
  worse.on_stall(10s, 1s, say("a test"));
  worse.on_stop(10s, true);
  worse.on_stop(10s, false);
  worse.on_stop(10s, true);  // and the next node says that it has missed SYNC
  EXPECT_FALSE(clears_and_goes_on(worse, 10s));
  StallRecovery late(machine_, events_);
  late.on_stall(10s, 1s, say("a test"));
  late.on_stop(10s, true);
  EXPECT_EQ(late.next(12s, 10s, true), StallRecovery::Step::kClear);
  late.on_stop(12s, false);
  EXPECT_EQ(late.next(13s, 12s, false), StallRecovery::Step::kNone)
      << "cleared, and stopped again for another cause";
}

TEST_F(StallRecoveryTest, ACommandTakesOver) {
  StallRecovery stall(machine_, events_);
  stall.on_stall(10s, 1s, say("a test"));
  stall.on_stop(10s, true);
  stall.commanded();
  EXPECT_FALSE(clears_and_goes_on(stall, 10s));
}

TEST_F(StallRecoveryTest, WaitsUntilEverythingThatIsWrongHasBeenTold) {
  StallRecovery stall(machine_, events_);
  stall.on_stall(10s, 1s, say("a test"));
  stall.on_stop(10s, true);
  EXPECT_EQ(stall.next(11s - 1ns, 10s, true), StallRecovery::Step::kNone);
  EXPECT_EQ(stall.next(11s, 10s, true), StallRecovery::Step::kClear);
}

TEST_F(StallRecoveryTest, FiveTimesInARowAndThenAPersonIsNeeded) {
  StallRecovery stall(machine_, events_);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(goes_on(stall, 10s + i * 600s)) << i;
  EXPECT_FALSE(goes_on(stall, 10s + 5 * 600s));
  bool told = false;
  while (const auto event = events_.pop())
    told = told || event->words.find("waits for a person") != std::string::npos;
  EXPECT_TRUE(told);
  EXPECT_EQ(stall.next(3100s, 3100s, false), StallRecovery::Step::kNone) << "it stands no more";
  EXPECT_FALSE(goes_on(stall, 10s + 6 * 600s)) << "until somebody commands";
  EXPECT_EQ(stall.next(3700s, 3700s, false), StallRecovery::Step::kNone);
  stall.commanded();
  EXPECT_TRUE(goes_on(stall, 10s + 7 * 600s));
  StallRecovery seldom(machine_, events_);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(goes_on(seldom, 10s + i * 601s)) << "it ran for long in between";
}

}  // namespace
}  // namespace kinebus
