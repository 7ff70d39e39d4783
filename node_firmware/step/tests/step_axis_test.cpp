// Steps against the motion that they are made of: how many in every slot, when each comes, and what a driver
// needs.

#include "node_firmware/step/step_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace kinebus::step {
namespace {

constexpr int kStepBits = 4;
constexpr double kCount = 4294967296.0;
constexpr std::uint32_t kStepPin = 1u << 13, kDirectionPin = 1u << 12;

/// Constant accelerations one after another, exact: counts with 32 fractional bits, time in 250 ns.
class Profile {
 public:
  void add(std::int64_t duration, std::int64_t acceleration) {
    pieces_.push_back({end_, place_, velocity_, acceleration});
    place_ += velocity_ * duration + acceleration * (duration * (duration - 1) / 2);
    velocity_ += acceleration * duration;
    end_ += duration;
  }
  std::int64_t at(std::int64_t time) const {
    auto piece = std::upper_bound(pieces_.begin(), pieces_.end(), time,
                                  [](std::int64_t t, const Piece& p) { return t < p.begin; });
    if (piece == pieces_.begin()) return 0;
    --piece;
    const std::int64_t t = std::min(time, end_) - piece->begin;
    return piece->place + piece->velocity * t + piece->acceleration * (t * (t - 1) / 2);
  }
  std::int64_t velocity() const { return velocity_; }
  std::int64_t end() const { return end_; }

 private:
  struct Piece {
    std::int64_t begin, place, velocity, acceleration;
  };
  std::vector<Piece> pieces_;
  std::int64_t place_ = 0, velocity_ = 0, end_ = 0;
};

MotionPlan plan_of(const Profile& profile, std::int64_t from, PlanCounts zero) {
  MotionPlan plan;
  plan.start = zero + static_cast<PlanCounts>(from);
  for (auto& piece : plan.pieces[0]) {
    piece = MotionPlan::through(profile.at(from), profile.at(from + MotionPlan::kPiece / 2),
                                profile.at(from + MotionPlan::kPiece));
    from += MotionPlan::kPiece;
  }
  return plan;
}

std::int64_t nearest_step(std::int64_t place) {
  return (place + (std::int64_t{1} << (31 + kStepBits))) >> (32 + kStepBits);
}

/// A driver at two pins: counts, and knows what it needs. Times in slots.
struct Driver {
  void on_word(std::int64_t slot, std::uint32_t word) {
    const auto drive = [&](std::uint32_t pin, bool& level, auto&& changed) {
      const bool to = (word & pin) != 0 || (level && (word & pin << 16) == 0);
      if (to == level) return;
      level = to;
      changed(to);
    };
    drive(kStepPin, high, [&](bool rise) {
      if (!rise) {
        EXPECT_GE(slot - last_rise, kPulse);
        fell = slot;
        return;
      }
      EXPECT_GE(slot - fell, kSpacing - kPulse);
      EXPECT_GE(slot - turned, kSetUp) << "the direction is set before a step";
      steps += up ? 1 : -1;
      rises.push_back({slot, steps, up, slot - last_rise == kSpacing});
      last_rise = slot;
    });
    drive(kDirectionPin, up, [&](bool) {
      EXPECT_GE(slot - last_rise, kSpacing - kSetUp) << "the direction is held after a step";
      EXPECT_FALSE(high);
      turned = slot;
    });
  }
  struct Rise {
    std::int64_t slot, after;
    bool up, held_back;
  };
  bool up = false, high = false;
  std::int64_t last_rise = -100, fell = -100, turned = -100, steps = 0;
  std::vector<Rise> rises;
};

/// The way from plan to pins, frame by frame.
struct Line {
  StepAxis<kStepBits> axis;
  StepFrames<1> frames;
  Driver driver;
  std::int64_t slot = 0;  // of the frame that comes next

  bool frame(const MotionPlan& plan, PlanCounts zero) {
    return frame(planned_way(plan, 0, zero + static_cast<PlanCounts>(slot) * kSlotCounts));
  }
  bool frame(const PlannedWay& way) {
    const std::size_t half = static_cast<std::size_t>(slot / kSlots % 2);
    frames.begin(half);
    struct {
      StepFrames<1>& frames;
      void step(int at) {
        frames.lane(0).pulse(at, kStepPin);
        frames.mark(0);
      }
      void early_step(int at) {
        frames.lane(0).early_pulse(at, kStepPin);
        frames.mark(0);
      }
      void turn(int at, bool up) { frames.put(0, at, up ? kDirectionPin : kDirectionPin << 16); }
    } put{frames};
    const bool good = axis.fill(way, put);
    for (std::size_t i = 0; i < kSlots; ++i)
      driver.on_word(slot + static_cast<std::int64_t>(i), frames.words(0)[half * kSlots + i]);
    slot += kSlots;
    return good;
  }
};

struct Outcome {
  double worst_us = 0;
  double fastest = 0;  ///< steps/s
  std::size_t steps = 0, reversals = 0, held_back = 0;
};

/// Random motions: up to 200,000 steps/s, 800,000 steps/s^2, reversals and rests, plans renewed at any time.
Outcome run_random(unsigned seed) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const auto below = [&](std::int64_t n) {
    return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(n));
  };
  const std::int64_t most_velocity = static_cast<std::int64_t>(0.8 * kCount);  // 3.2 counts/us
  const auto most_acceleration = static_cast<std::int64_t>(12.8e6 * 250e-9 * 250e-9 * kCount);
  Profile profile;
  Outcome outcome;
  profile.add(2'000, 0);
  for (int i = 0; i < 60; ++i) {
    std::int64_t a = below(2 * most_acceleration + 1) - most_acceleration;
    if (below(4) == 0) a = profile.velocity() > 0 ? -most_acceleration : most_acceleration;
    if (below(8) == 0) a = 0;
    std::int64_t duration = 1 + below(seed % 4 == 0 && below(8) == 0 ? 1'500'000
                                      : below(3) == 0                ? 60'000
                                                                     : 3'000);
    if (a > 0) duration = std::min(duration, (most_velocity - profile.velocity()) / a);
    if (a < 0) duration = std::min(duration, (most_velocity + profile.velocity()) / -a);
    if (duration > 0) profile.add(duration, a);
    outcome.fastest =
        std::max(outcome.fastest, std::abs(static_cast<double>(profile.velocity())) / kCount / 16 * 4e6);
  }
  while (profile.velocity() != 0) {  // to rest
    const std::int64_t a = std::clamp(-profile.velocity(), -most_acceleration, most_acceleration);
    profile.add(std::max<std::int64_t>(1, std::abs(profile.velocity()) / std::abs(a)), a);
  }
  profile.add(2'000, 0);

  const PlanCounts zero = 0xFFFF'0000;  // across the end of 32 bits, too
  Line line;
  MotionPlan plan = plan_of(profile, 0, zero);
  std::int64_t renewed = 0;
  while (line.slot * kSlotCounts < profile.end() + 1'000) {
    // A frame is computed while the one before it begins.
    const std::int64_t now = (line.slot - kSlots) * kSlotCounts;
    if (now - renewed > 4'000 + below(8'000)) plan = plan_of(profile, renewed = now - below(200), zero);
    EXPECT_TRUE(line.frame(plan, zero));
    // Exact at the control tick: the first slot of this frame that could still be given a step by this plan.
    const std::int64_t in_pipe = line.axis.steps();
    const std::int64_t wanted = nearest_step(
        plan.at(0, zero + static_cast<PlanCounts>((line.slot + kSetUp - 1) * kSlotCounts)).position);
    EXPECT_LE(std::abs(in_pipe - wanted), 1);
    if (in_pipe != wanted) ++outcome.held_back;
    if (testing::Test::HasFailure()) return outcome;
  }
  EXPECT_EQ(line.driver.steps, nearest_step(profile.at(profile.end()))) << "a step was lost";

  const double off = 0.12 * kCount;  // of the plan from the motion: MotionPlan, Delta a / 60 * (512 us)^2
  bool was_up = true;
  for (const Driver::Rise& rise : line.driver.rises) {
    ++outcome.steps;
    if (rise.up != was_up) ++outcome.reversals;
    was_up = rise.up;
    const std::int64_t below_step = rise.up ? rise.after - 1 : rise.after;
    const double border = static_cast<double>((2 * below_step + 1)) * kCount * (1 << kStepBits) / 2;
    // The nearest time at which the motion is at the border.
    int found = -1;
    for (int away = 0; away <= 8 && found < 0; ++away)
      for (const int side : {-1, 1}) {
        const double place = static_cast<double>(profile.at(rise.slot * kSlotCounts + side * away));
        const double next = static_cast<double>(profile.at(rise.slot * kSlotCounts + side * (away + 1)));
        if (std::min(place, next) - off <= border && border <= std::max(place, next) + off) found = away;
      }
    if (found >= 0) outcome.worst_us = std::max(outcome.worst_us, found * 0.25);
    if (found < 0 && rise.held_back)
      ++outcome.held_back;
    else
      EXPECT_GE(found, 0) << "a step at slot " << rise.slot << " is more than 2 us from its time";
  }
  return outcome;
}

TEST(StepAxis, FollowsRandomMotionsStepByStepWithinTwoMicroseconds) {
  Outcome all;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    const Outcome one = run_random(seed);
    all.worst_us = std::max(all.worst_us, one.worst_us);
    all.fastest = std::max(all.fastest, one.fastest);
    all.steps += one.steps;
    all.reversals += one.reversals;
    all.held_back += one.held_back;
    if (HasFailure()) return;
  }
  RecordProperty("steps", static_cast<int>(all.steps));
  EXPECT_GT(all.steps, 100'000u);
  EXPECT_GT(all.reversals, 50u);
  EXPECT_GT(all.fastest, 195'000);
  EXPECT_LE(all.worst_us, 2.0);
  EXPECT_LT(all.held_back, all.steps / 1000);
}

/// The number of steps in every slot against the parabola itself.
TEST(StepAxis, IsExactInEverySlotOfAFrame) {
  std::mt19937_64 random(3);
  int either = 0;
  for (int round = 0; round < 3'000; ++round) {
    Line line;
    // Up to 200,000 steps/s and 12.8 counts/ms^2 either way, in counts with 32 fractional bits.
    const auto span = static_cast<std::int64_t>(204 * kCount);
    const std::int64_t way =
        static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(2 * span)) - span;
    const std::int64_t bow = static_cast<std::int64_t>(random() % (1ULL << 26)) - (std::int64_t{1} << 25);
    const std::int64_t middle = way / 2 + bow;
    ASSERT_TRUE(line.frame(PlannedWay::through(0, middle, way)));
    ASSERT_TRUE(line.frame(PlannedWay::through(way, way, way)));
    std::size_t next = 0;
    std::int64_t steps = 0;
    const std::int64_t second = 2 * way - 4 * middle, first = 4 * middle - way;
    for (std::int64_t slot = 0; slot < kSlots; ++slot) {
      while (next < line.driver.rises.size() && line.driver.rises[next].slot <= slot + kSetUp)
        steps = line.driver.rises[next++].after;
      // Exact: 4096 times the place.
      const __int128 place =
          static_cast<__int128>(first) * slot * 64 + static_cast<__int128>(second) * slot * slot;
      // Within the tolerance of a border either number is right.
      const auto near = static_cast<__int128>(StepAxis<kStepBits>::kTolerance * kCount * 4096);
      const auto nearest = [&](__int128 at) {
        return static_cast<std::int64_t>((at + (__int128{1} << (43 + kStepBits))) >> (44 + kStepBits));
      };
      ASSERT_GE(steps, nearest(place - near)) << "round " << round << ", slot " << slot;
      ASSERT_LE(steps, nearest(place + near)) << "round " << round << ", slot " << slot;
      either += nearest(place - near) != nearest(place + near) ? 1 : 0;
    }
    ASSERT_EQ(line.driver.steps, nearest_step(way));
  }
  EXPECT_LT(either, 20) << "slots of 192,000 in which the tolerance decides";
}

TEST(StepAxis, TwoHundredThousandStepsASecondAreEvenlySpaced) {
  Line line;
  const auto frame = static_cast<std::int64_t>(3.2 * kSlots * kCount);
  for (std::int64_t i = 0; i < 1'000; ++i)
    ASSERT_TRUE(line.frame(PlannedWay::through(i * frame, i * frame + frame / 2, (i + 1) * frame)));
  EXPECT_NEAR(static_cast<double>(line.driver.steps), 12'800, 1);
  for (std::size_t i = 1; i < line.driver.rises.size(); ++i) {
    const std::int64_t apart = line.driver.rises[i].slot - line.driver.rises[i - 1].slot;
    ASSERT_GE(apart, 4);
    ASSERT_LE(apart, 6);
  }
}

// Turned back just beyond a border: both steps are made, as near to each other as a driver allows.
TEST(StepAxis, ATurnJustBeyondABorderLosesNoStep) {
  const auto border = static_cast<std::int64_t>(8 * kCount);
  std::size_t made = 0;
  for (std::int64_t beyond = -20; beyond < 4'000'000; beyond = beyond < 20 ? beyond + 1 : beyond * 3 / 2) {
    Line line;
    const std::int64_t top = border + beyond, depth = static_cast<std::int64_t>(0.02 * kCount);
    ASSERT_TRUE(line.frame(PlannedWay::through(top - depth, top, top - depth)));
    for (int i = 0; i < 3; ++i)
      ASSERT_TRUE(line.frame(PlannedWay::through(top - depth, top - depth, top - depth)));
    EXPECT_EQ(line.driver.steps, 0);
    EXPECT_TRUE(line.driver.rises.empty() || line.driver.rises.size() == 2);
    made += line.driver.rises.size();
  }
  EXPECT_GT(made, 20u);
}

/// A way at constant speed, in counts.
PlannedWay steady(double from, double counts) {
  return {static_cast<std::int64_t>(from * kCount), static_cast<std::int64_t>(counts * kCount), 0};
}

// A frame that begins behind its plan, which is slow: what is missing is made as fast as steps go.
TEST(StepAxis, WhatIsMissingIsMadeUpAtOnceHoweverSlowThePlan) {
  for (const double counts : {1.0, 30.0, 100.0}) {
    Line line;
    ASSERT_TRUE(line.frame(steady(56.5, counts)));  // beyond four borders
    ASSERT_GE(line.driver.rises.size(), 4u);
    for (std::size_t i = 1; i < 4; ++i)
      EXPECT_EQ(line.driver.rises[i].slot - line.driver.rises[i - 1].slot, kSpacing) << counts;
  }
}

// The step of a frame's last slot holds back the next one by what a driver needs, and no longer.
TEST(StepAxis, AFasterPlanAfterAStepAtAFramesEndIsFollowedAtOnce) {
  Line line;
  ASSERT_TRUE(line.frame(steady(-6.6, 15)));
  ASSERT_TRUE(line.frame(steady(8.4, 204)));
  ASSERT_TRUE(line.frame(steady(212.4, 0)));
  ASSERT_GE(line.driver.rises.size(), 10u);
  std::int64_t before = kSlots - 1 + kSetUp;
  EXPECT_EQ(line.driver.rises[0].slot, before);
  for (std::size_t i = 1; i < 10; ++i) {
    const std::int64_t rise = line.driver.rises[i].slot;
    EXPECT_LE(rise - before, 6) << i;
    before = rise;
  }
}

TEST(StepAxis, APlanThatJumpsIsToldAndNotFollowed) {
  Line line;
  const auto far = static_cast<std::int64_t>(1'000 * kCount);
  EXPECT_FALSE(line.frame(PlannedWay::through(far, far, far)));
  EXPECT_FALSE(line.frame(PlannedWay::through(0, 0, far)));
  EXPECT_FALSE(line.frame(PlannedWay::through(0, far, 0)));
  EXPECT_TRUE(line.driver.rises.empty());
  line.axis.follow(PlannedWay::through(far, far, far));
  EXPECT_EQ(line.axis.steps(), nearest_step(far));
  EXPECT_TRUE(line.frame(PlannedWay::through(far, far, far)));
  EXPECT_TRUE(line.driver.rises.empty());
}

TEST(StepAxis, MoreThanItsFastestIsToldAsSoonAsItFallsBehind) {
  Line line;
  const auto frame = static_cast<std::int64_t>(1.1 * 16 * 16 * kCount);  // 275,000 steps/s
  int good = 0;
  for (std::int64_t i = 0;
       i < 20 && line.frame(PlannedWay::through(i * frame, i * frame + frame / 2, (i + 1) * frame)); ++i)
    ++good;
  EXPECT_GE(good, 1);
  EXPECT_LE(good, 4);
}

}  // namespace
}  // namespace kinebus::step
