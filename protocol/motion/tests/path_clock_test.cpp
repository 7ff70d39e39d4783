#include "protocol/motion/path_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>
#include <vector>

namespace kinebus {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using Outcome = PathClock::Outcome;

RateCommand rate(double value, BusTime start, int counter = 0, int ramp_ms = 100) {
  return {RateCommand::Kind::kRate, static_cast<std::uint8_t>(counter),
          static_cast<std::uint16_t>(value * 32768), static_cast<std::uint8_t>(ramp_ms / 2), start};
}
RateCommand stop(BusTime start, int counter = 0, int ramp_ms = 100) {
  return {RateCommand::Kind::kStop, static_cast<std::uint8_t>(counter), 0,
          static_cast<std::uint8_t>(ramp_ms / 2), start};
}
RateCommand clear(BusTime start, int counter = 0) {
  return {RateCommand::Kind::kClear, static_cast<std::uint8_t>(counter), 0, 50, start};
}
RateCommand smooth(double value, BusTime start, int counter = 0, int ramp_ms = 200) {
  RateCommand command = rate(value, start, counter, ramp_ms / 2);
  command.kind = RateCommand::Kind::kSmooth;
  return command;
}
double rate_of(const PathClock& clock, BusTime t) {
  return static_cast<double>(clock.rate_q32(t)) / 4294967296.0;
}
double seconds_of(PathTime t) {
  return to_seconds(t);
}

TEST(PathClock, StandsStillAtPowerUp) {
  const PathClock clock;
  EXPECT_EQ(clock.tau(seconds{5}), PathTime{0});
  EXPECT_TRUE(clock.at_rest(seconds{5}));
  EXPECT_FALSE(clock.when(PathTime{1}));
}

TEST(PathClock, RampsThenRunsAtFullRate) {
  PathClock clock;
  EXPECT_EQ(clock.apply(rate(1.0, seconds{10}), seconds{9}), Outcome::kScheduled);
  EXPECT_EQ(clock.tau(seconds{10}), PathTime{0});
  EXPECT_NEAR(seconds_of(clock.tau(seconds{10} + milliseconds{50})), 0.0125, 1e-7);
  EXPECT_NEAR(seconds_of(clock.tau(seconds{10} + milliseconds{100})), 0.05, 1e-7);
  // Ten hours on, to the tick: rate 1 is exact.
  const PathTime at_end = clock.tau(seconds{10} + milliseconds{100});
  EXPECT_NEAR(static_cast<double>((clock.tau(seconds{36010} + milliseconds{100}) - at_end).count()),
              36000.0 * 16e6, 1);
  EXPECT_EQ(clock.rate_q32(seconds{11}), std::uint64_t{1} << 32);
}

TEST(PathClock, SmallerChangesRampInProportionallyLessTime) {
  PathClock clock;
  clock.apply(rate(1.0, seconds{1}, 0), seconds{0});
  clock.apply(rate(0.5, seconds{2}, 1), seconds{2});
  EXPECT_EQ(clock.next_change(seconds{2}), BusTime{seconds{2} + milliseconds{50}});
  EXPECT_EQ(clock.rate_q32(seconds{2} + milliseconds{50}), std::uint64_t{1} << 31);
}

TEST(PathClock, CommandsMayComeInAnyOrderBeforeTheStop) {
  PathClock a, b;
  a.apply(rate(1.0, seconds{1}, 0), seconds{0});
  b.apply(rate(1.0, seconds{1}, 0), seconds{0});
  a.apply(rate(0.25, seconds{2}, 1), seconds{1});
  a.stop_at(seconds{2} + milliseconds{20}, 50, seconds{1});
  b.stop_at(seconds{2} + milliseconds{20}, 50, seconds{1});
  b.apply(rate(0.25, seconds{2}, 1), seconds{1});
  for (BusTime t = seconds{1}; t < seconds{3}; t += microseconds{777}) ASSERT_EQ(a.tau(t), b.tau(t));
}

TEST(PathClock, EarliestStopWinsWhicheverComesFirst) {
  PathClock a, b;
  for (PathClock* clock : {&a, &b}) clock->apply(rate(1.0, seconds{1}), seconds{0});
  a.stop_at(seconds{2}, 50, seconds{1});
  EXPECT_EQ(a.stop_at(seconds{2} + milliseconds{3}, 50, seconds{1}), Outcome::kDuplicate);
  b.stop_at(seconds{2} + milliseconds{3}, 50, seconds{1});
  EXPECT_EQ(b.stop_at(seconds{2}, 50, seconds{1}), Outcome::kScheduled);
  for (BusTime t = seconds{1}; t < seconds{3}; t += microseconds{500}) ASSERT_EQ(a.tau(t), b.tau(t));
  EXPECT_TRUE(a.at_rest(seconds{2} + milliseconds{100}));
}

TEST(PathClock, AStopStaysUntilCleared) {
  PathClock clock;
  clock.apply(rate(1.0, seconds{1}, 0), seconds{0});
  clock.apply(stop(seconds{2}, 1), seconds{2});
  EXPECT_EQ(clock.apply(rate(1.0, seconds{3}, 2), seconds{2}), Outcome::kLatched);
  EXPECT_EQ(clock.apply(clear(seconds{2} + milliseconds{50}, 3), seconds{2} + milliseconds{50}),
            Outcome::kNotAtRest);
  EXPECT_EQ(clock.apply(clear(seconds{3}, 4), seconds{3}), Outcome::kScheduled);
  EXPECT_FALSE(clock.stop_latched());
  EXPECT_EQ(clock.apply(rate(1.0, seconds{4}, 5), seconds{3}), Outcome::kScheduled);
  EXPECT_GT(clock.tau(seconds{5}), clock.tau(seconds{4}));
}

TEST(PathClock, ADoubledFrameIsNoSecondCommand) {
  PathClock clock;
  clock.apply(rate(1.0, seconds{1}, 0), seconds{0});
  const PathTime before = clock.tau(seconds{2});
  EXPECT_EQ(clock.apply(rate(1.0, seconds{1}, 0), seconds{2}), Outcome::kDuplicate);
  EXPECT_EQ(clock.tau(seconds{2}), before);
}

TEST(PathClock, AShortlyLateCommandCountsFromItsStart) {
  PathClock in_time, late;
  for (PathClock* clock : {&in_time, &late}) clock->apply(rate(1.0, seconds{1}), seconds{0});
  in_time.stop_at(seconds{2}, 50, seconds{1});
  EXPECT_EQ(late.stop_at(seconds{2}, 50, seconds{2} + microseconds{900}), Outcome::kLateRewound);
  for (BusTime t = seconds{2}; t < seconds{3}; t += microseconds{500}) ASSERT_EQ(in_time.tau(t), late.tau(t));
}

// 5 ms late at full rate: what has been run too far is 125 us of path. It is taken back by a steeper ramp,
// never by a step, and all end at the same place.
TEST(PathClock, ALateCommandCatchesUpWithoutAStep) {
  struct Case {
    double from, to;
    int late_us;
  };
  for (const Case c : {Case{1, 0, 5000}, Case{0, 1, 5000}, Case{1, 0.25, 8000}, Case{0.3, 1, 2500},
                       Case{1, 0, 11900}, Case{0.5, 0, 4000}}) {
    SCOPED_TRACE(testing::Message() << c.from << " to " << c.to << ", late by " << c.late_us << " us");
    PathClock in_time, late;
    for (PathClock* clock : {&in_time, &late}) clock->apply(rate(c.from, seconds{1}), seconds{0});
    const BusTime heard = seconds{2} + microseconds{c.late_us};
    const PathTime before = late.tau(heard);
    in_time.apply(rate(c.to, seconds{2}, 1), seconds{2});
    EXPECT_EQ(late.apply(rate(c.to, seconds{2}, 1), heard), Outcome::kLateCaughtUp);
    EXPECT_EQ(late.tau(heard), before);
    PathTime last = before;
    double last_rate = static_cast<double>(late.rate_q32(heard));
    for (BusTime t = heard; t < heard + milliseconds{120}; t += microseconds{10}) {
      ASSERT_GE(late.tau(t), last);
      ASSERT_LE(late.tau(t) - last, PathTime{162});  // 10 us of 16 ticks, and rounding
      ASSERT_LE(std::abs(static_cast<double>(late.rate_q32(t)) - last_rate), 4294967296.0 * 1.34e-4);
      last = late.tau(t);
      last_rate = static_cast<double>(late.rate_q32(t));
    }
    for (BusTime t = seconds{2} + milliseconds{101}; t < seconds{3}; t += microseconds{500})
      ASSERT_EQ(in_time.tau(t), late.tau(t));
  }
}

TEST(PathClock, ASmoothRampTakesItsTimeAndHalfOfTheWay) {
  PathClock clock;
  clock.apply(smooth(1.0, seconds{1}), seconds{0});
  EXPECT_FALSE(clock.at_rest(seconds{1}));
  EXPECT_NEAR(rate_of(clock, seconds{1} + milliseconds{50}), 0.125, 1e-8);
  EXPECT_NEAR(rate_of(clock, seconds{1} + milliseconds{100}), 0.5, 1e-8);
  EXPECT_NEAR(seconds_of(clock.tau(seconds{1} + milliseconds{50})), 0.05 * 0.125 / 3, 1e-7);
  EXPECT_NEAR(seconds_of(clock.tau(seconds{1} + milliseconds{200})), 0.1, 1e-7);
  clock.apply(smooth(0.2, seconds{2}, 1, 100), seconds{2});
  EXPECT_EQ(rate_of(clock, seconds{2} + milliseconds{100}), 6553.0 / 32768);
  clock.apply(smooth(0, seconds{3}, 2), seconds{2});
  EXPECT_FALSE(clock.at_rest(seconds{3} + milliseconds{199}));
  EXPECT_TRUE(clock.at_rest(seconds{3} + milliseconds{200}));
}

// A hold while the machine speeds up, a resume while it holds, one upon another: the rate's slope never
// jumps, and tau never runs back.
TEST(PathClock, SmoothRampsThatCutEachOtherShortJoinWithoutAJump) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const auto below = [&](std::int64_t limit) {
      return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(limit));
    };
    PathClock clock;
    BusTime t = seconds{1};
    double steepest = 0;  // change of the slope, per s^2
    constexpr BusTime kStep = microseconds{100};
    constexpr double kStep_s = 1e-4;
    double last = 0, slope = 0;
    PathTime tau{0};
    for (int i = 0; i < 40; ++i) {
      const int ramp_ms = static_cast<int>(4 * (5 + below(251)));
      steepest = std::max(steepest, 4e6 / ramp_ms / ramp_ms);
      const BusTime start = t + microseconds{below(5000)};
      ASSERT_EQ(clock.apply(smooth(static_cast<double>(below(5)) / 4, start, i % 16, ramp_ms), t),
                Outcome::kScheduled);
      const BusTime until = start + milliseconds{1 + below(i % 3 == 0 ? 1800 : 400)};
      for (; t < until; t += kStep) {
        const double now = rate_of(clock, t), slope_now = (now - last) / kStep_s;
        ASSERT_LE(std::abs(slope_now - slope), steepest * kStep_s * 1.001 + 1e-4) << to_seconds(t);
        ASSERT_GE(clock.tau(t), tau);
        ASSERT_NEAR(seconds_of(clock.tau(t) - tau), 0.5 * (now + last) * kStep_s, 1.3e-7) << to_seconds(t);
        tau = clock.tau(t);
        last = now;
        slope = slope_now;
      }
      clock.forget_before(t);
    }
  }
}

TEST(PathClock, AStopCutsASmoothRampShort) {
  PathClock clock;
  clock.apply(smooth(1.0, seconds{1}), seconds{0});
  clock.stop_at(seconds{1} + milliseconds{100}, 50, seconds{1});
  EXPECT_NEAR(rate_of(clock, seconds{1} + milliseconds{125}), 0.25, 1e-6);
  EXPECT_TRUE(clock.at_rest(seconds{1} + milliseconds{151}));
}

TEST(PathClock, ALateSmoothRampCatchesUpWithoutAStep) {
  for (const auto& [from, to, late_us] :
       {std::tuple{1.0, 0.0, 8000}, {0.0, 1.0, 9000}, {1.0, 0.5, 11000}, {0.25, 1.0, 11900}}) {
    SCOPED_TRACE(testing::Message() << from << " to " << to << ", late by " << late_us << " us");
    PathClock in_time, late;
    for (PathClock* clock : {&in_time, &late}) clock->apply(rate(from, seconds{1}), seconds{0});
    const BusTime heard = seconds{2} + microseconds{late_us};
    const PathTime before = late.tau(heard);
    in_time.apply(smooth(to, seconds{2}, 1), seconds{2});
    EXPECT_EQ(late.apply(smooth(to, seconds{2}, 1), heard), Outcome::kLateCaughtUp);
    EXPECT_EQ(late.tau(heard), before);
    for (BusTime t = seconds{2} + milliseconds{200}; t < seconds{3}; t += microseconds{500})
      ASSERT_EQ(in_time.tau(t), late.tau(t));
  }
}

TEST(PathClock, AVeryLateRateIsVoid) {
  PathClock clock;
  clock.apply(rate(1.0, seconds{1}), seconds{0});
  const BusTime heard = seconds{2} + milliseconds{30};
  EXPECT_EQ(clock.apply(rate(0.25, seconds{2}), heard), Outcome::kTooLate);
  EXPECT_EQ(clock.apply(rate(0.25, seconds{2}), heard + milliseconds{1}), Outcome::kDuplicate);
  EXPECT_EQ(clock.rate_q32(seconds{3}), std::uint64_t{1} << 32);
  EXPECT_EQ(clock.apply(rate(0.25, seconds{4}), seconds{3}), Outcome::kScheduled);
}

TEST(PathClock, AVeryLateStopStartsNowAndSaysSo) {
  PathClock clock;
  clock.apply(rate(1.0, seconds{1}), seconds{0});
  EXPECT_EQ(clock.stop_at(seconds{2}, 50, seconds{2} + milliseconds{30}), Outcome::kLateStarted);
  EXPECT_EQ(clock.stop_start(), BusTime{seconds{2} + milliseconds{30}});
  EXPECT_TRUE(clock.at_rest(seconds{2} + milliseconds{130}));
}

TEST(PathClock, RampsAreNeverSteeperThanAllowed) {
  PathClock clock(PathClock::Options{.least_full_ramp_2ms = 50});
  clock.apply(rate(1.0, seconds{1}, 0, 2), seconds{0});
  EXPECT_EQ(clock.next_change(seconds{1}), BusTime{seconds{1} + milliseconds{100}});
}

TEST(PathClock, TauIsSetOnlyAtRest) {
  PathClock clock;
  EXPECT_TRUE(clock.set_tau(PathTime{16'000'000}, seconds{1}));
  EXPECT_EQ(clock.tau(seconds{1}), PathTime{16'000'000});
  clock.apply(rate(0.5, seconds{2}), seconds{1});
  EXPECT_FALSE(clock.set_tau(PathTime{0}, seconds{1}));
  EXPECT_FALSE(clock.set_tau(PathTime{0}, seconds{3}));
}

TEST(PathClock, ANewEpochMovesAllTimes) {
  PathClock clock, moved;
  for (PathClock* c : {&clock, &moved}) {
    c->apply(rate(1.0, seconds{100}, 0), seconds{99});
    c->stop_at(seconds{105}, 50, seconds{101});
  }
  moved.shift(-seconds{90});
  for (BusTime t = seconds{100}; t < seconds{106}; t += milliseconds{7})
    ASSERT_EQ(clock.tau(t), moved.tau(t - seconds{90}));
}

TEST(PathClock, AStopFindsRoomHoweverMuchIsAhead) {
  PathClock clock;
  int accepted = 0;
  for (int i = 0; i < 40; ++i)
    if (clock.apply(rate(i % 2 == 0 ? 1.0 : 0.5, seconds{i + 1}, i % 16), seconds{0}) == Outcome::kScheduled)
      ++accepted;
  EXPECT_GE(accepted, 8);
  EXPECT_EQ(clock.stop_at(seconds{60}, 50, seconds{0}), Outcome::kScheduled);
  EXPECT_TRUE(clock.at_rest(seconds{61}));
}

// Random commands: two clocks that hear the same at different times agree to the last tick; tau never runs
// back; and when() is the exact inverse.
TEST(PathClock, IsMonotoneExactAndInvertibleUnderRandomCommands) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937_64 random(seed);
    const auto below = [&](std::int64_t limit) {
      return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(limit));
    };
    PathClock early, late;
    BusTime t = seconds{below(100'000)};
    PathTime last{0};
    for (int step = 0; step < 60; ++step) {
      const BusTime start = BusTime{(t.count() / 1000 + 2000 + below(300'000)) * 1000};
      RateCommand command = rate(static_cast<double>(below(32769)) / 32768, start, step % 16,
                                 static_cast<int>(2 + 2 * below(255)));
      if (random() % 2 == 0) command.kind = RateCommand::Kind::kSmooth;
      if (step % 13 == 7) command.kind = RateCommand::Kind::kStop;
      early.apply(command, t);
      const BusTime heard = t + BusTime{below(2'000'000)};
      for (int i = 0; i < 50; ++i) {
        const BusTime u = t + (start + seconds{1} - t) * i / 50;
        const PathTime tau = early.tau(u);
        if (u >= heard && i > 0) {
          ASSERT_GE(tau, last) << "seed " << seed;
        }
        last = i == 0 ? tau : std::max(last, tau);
      }
      const PathTime before = late.tau(heard);
      const Outcome outcome = late.apply(command, heard);
      ASSERT_LE(std::abs((late.tau(heard) - before).count()), PathClock::Options{}.most_step.count());
      const BusTime same = outcome == Outcome::kLateCaughtUp ? start + milliseconds{1530} : start;
      for (int i = 0; i < 20; ++i) {
        const BusTime u = same + BusTime{below(1'000'000'000)};
        ASSERT_EQ(early.tau(u), late.tau(u)) << "seed " << seed << " step " << step;
        const PathTime wanted = early.tau(u) + PathTime{1};
        if (const auto when = early.when(wanted)) {
          ASSERT_GE(early.tau(*when), wanted) << "seed " << seed;
          ASSERT_LT(early.tau(*when - BusTime{1}), wanted) << "seed " << seed;
        }
      }
      if (step % 13 == 8) {
        const BusTime rest = start + seconds{2};
        RateCommand lift = clear(rest, step % 16);
        early.apply(lift, rest);
        late.apply(lift, rest);
        t = rest;
      }
      t += BusTime{below(400'000'000)};
      early.forget_before(t);
      last = early.tau(t);
    }
  }
}

TEST(PathClock, WhoRemembersLongTakesEveryOneOfManyCommandsInAShortTime) {
  PathClock node, gateway({.rewind = seconds{2}, .most_step = PathTime::max()});
  BusTime t = seconds{1};
  for (int i = 0; i < 60; ++i, t += milliseconds{40}) {
    const RateCommand command = rate(i % 2 == 0 ? 1.0 : 0.0, t + milliseconds{5}, i % 16, 20);
    EXPECT_EQ(gateway.apply(command, t), PathClock::Outcome::kScheduled) << i;
    EXPECT_EQ(node.apply(command, t), PathClock::Outcome::kScheduled) << i;
    EXPECT_EQ(gateway.tau(t + milliseconds{30}), node.tau(t + milliseconds{30})) << i;
  }
}

TEST(PathClock, EveryNanosecondOfARampIsMonotone) {
  PathClock clock;
  clock.apply(rate(1.0, seconds{1}, 0, 2), seconds{0});
  clock.apply(stop(seconds{2}, 1, 510), seconds{1});
  const BusTime end = seconds{2} + milliseconds{510};
  for (BusTime t = end - microseconds{300}; t < end + microseconds{2}; ++t)
    ASSERT_LE(clock.tau(t), clock.tau(t + BusTime{1}));
  PathClock gentle;
  gentle.apply(smooth(1.0, seconds{1}, 0, 1020), seconds{0});
  gentle.apply(smooth(0.0, seconds{3}, 1, 1020), seconds{1});
  for (const BusTime from : {BusTime{seconds{1}}, BusTime{seconds{3} + milliseconds{510} - microseconds{100}},
                             BusTime{seconds{3} + milliseconds{1020} - microseconds{300}}})
    for (BusTime t = from; t < from + microseconds{310}; ++t)
      ASSERT_LE(gentle.tau(t), gentle.tau(t + BusTime{1}));
}

}  // namespace
}  // namespace kinebus
