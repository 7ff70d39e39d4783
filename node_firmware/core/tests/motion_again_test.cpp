// What is planned anew is as if nothing had been before; what need not be planned anew goes on, to the bit.

#include "node_firmware/core/linear_interpolator.hpp"
#include "node_firmware/core/motion_plan.hpp"
#include "node_firmware/core/profile_position.hpp"
#include "node_firmware/core/tests/interpolator_chance.hpp"
#include "node_firmware/core/tests/lone_bench.hpp"
#include "node_firmware/core/transmit_queue.hpp"

namespace kinebus::testing_way {
namespace {

using namespace std::chrono_literals;

void expect_same(const LinearInterpolator& a, const LinearInterpolator& b, ProfileTicks from,
                 ProfileTicks span) {
  for (int i = 0; i <= 50; ++i) {
    const ProfileTicks t = from + span * i / 50;
    ASSERT_EQ(a.at(t).position, b.at(t).position) << i;
    ASSERT_EQ(a.at(t).velocity, b.at(t).velocity) << i;
    ASSERT_EQ(a.done(t), b.done(t)) << i;
  }
  ASSERT_EQ(a.end(), b.end());
  ASSERT_EQ(a.lost_at(), b.lost_at());
}

TEST(MotionAgain, ALineThatIsHeldIsAsNew) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    Chance chance(seed);
    const auto limits = limits_of(chance, 0.2, 5);
    Trapezoid profile_a, profile_b;
    LinearInterpolator used(profile_a), fresh(profile_b);
    used.hold(fixed(chance.within(1, 1000)));
    const ProfileTicks period = 32'000;
    ProfileTicks now = 0;
    std::int64_t target = used.at(0).position;
    const auto steps = chance.of(12);
    auto tight = limits;
    if (seed % 3 == 0) tight.high = target + fixed(50), tight.low = target - fixed(50);
    for (std::uint64_t i = 0; i < steps; ++i, now += period) {
      target += fixed(chance.sign() * chance.within(0.1, 200));
      (void)used.go(now, target, period, tight);
    }
    // At once, and after some time, in which SYNC did not come.
    now += static_cast<ProfileTicks>(chance.of(3)) * 40'000;
    const std::int64_t place = fixed(chance.sign() * chance.within(1, 5000));
    used.hold(place);
    fresh.hold(place);
    EXPECT_EQ(used.at(now).position, place);
    EXPECT_TRUE(used.done(now));
    EXPECT_EQ(used.lost_at(), LinearInterpolator::kNever);
    target = place;
    for (int i = 0; i < 6; ++i, now += period) {
      target += fixed(chance.within(0.1, 200));
      ASSERT_EQ(used.go(now, target, period, limits), fresh.go(now, target, period, limits));
      expect_same(used, fresh, now, period + 8000);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(MotionAgain, OnItsWayToStandSomewhereItGoesOnAsItWasPlanned) {
  int on_the_way = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Chance chance(seed);
    const auto limits = limits_of(chance, 0.2, 5);
    Trapezoid profile_a, profile_b;
    LinearInterpolator again(profile_a), once(profile_b);
    const std::int64_t target = fixed(chance.sign() * chance.within(10, 50'000));
    const ProfileTicks period = 16'000;
    // The first step is one to stand at: by the limits alone, whatever the period.
    (void)again.go(0, target, period, limits);
    (void)once.go(0, target, period, limits);
    for (ProfileTicks now = period; now < 60 * period; now += period) {
      (void)again.go(now, target, period, limits);
      for (const ProfileTicks t : {now, now + period / 3, now + period}) {
        ASSERT_EQ(again.at(t).position, profile_b.at(t).position) << now;
        ASSERT_EQ(again.at(t).velocity, profile_b.at(t).velocity) << now;
      }
      if (!again.done(now)) ++on_the_way;
    }
  }
  EXPECT_GT(on_the_way, 2'000);
}

/// How far it stays away, whether it stands, and whether a SYNC is waited for: as its motion then is, also
/// where a limit changes it.
TEST(MotionAgain, WhatALineSaysOfItsEndIsSo) {
  int at_limits = 0, stood = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    Chance chance(seed);
    auto limits = limits_of(chance, 0.2, 5);
    const auto period = static_cast<ProfileTicks>(chance.within(8'000, 160'000));
    const long double s = static_cast<long double>(period) / kTicks;
    Trapezoid profile;
    LinearInterpolator line(profile);
    line.hold(0);
    const int sign = chance.sign();
    const long double step = static_cast<long double>(limits.profile.velocity) * s * 0.8L;
    limits.high = fixed(step * static_cast<long double>(chance.within(3, 12)));
    limits.low = -limits.high;
    std::int64_t target = 0;
    ProfileTicks now = 0;
    for (int i = 0; i < 30; ++i, now += period) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << " " << i);
      const long double ramp = std::min(1.0L, 0.1L * (i + 1));
      target += sign * fixed(step * ramp * static_cast<long double>(chance.within(0.9, 1)));
      target = std::clamp(target, limits.low, limits.high);
      const std::int64_t off = line.go(now, target, period, limits);
      const ProfileState end = line.at(line.end());
      ASSERT_EQ(off == 0, end.position == target);
      ASSERT_LE(std::abs(off - std::abs(end.position - target)), 3);
      ASSERT_EQ(line.lost_at() == LinearInterpolator::kNever, end.velocity == 0);
      if (end.velocity == 0 && line.done(line.end())) ++stood;
      if (line.done(line.end())) {
        ASSERT_EQ(line.at(line.end() + 10 * period).position, end.position);
      }
      // Without another SYNC: within its limits, and no step.
      ProfileState last = line.at(now);
      const ProfileTicks part = std::max<ProfileTicks>(period / 64, 1);
      for (ProfileTicks t = now + part; t <= now + 4 * period; t += part) {
        const ProfileState is = line.at(t);
        const long double way = counts(is.position - last.position);
        const long double mean = (counts_per_s(is.velocity) + counts_per_s(last.velocity)) / 2;
        const long double dt = static_cast<long double>(part) / kTicks;
        const long double a = std::max(limits.profile.acceleration, limits.profile.deceleration);
        ASSERT_NEAR(static_cast<double>(way), static_cast<double>(mean * dt),
                    static_cast<double>(a * dt * dt / 2 + 1e-3L));
        ASSERT_LE(std::abs(is.position), limits.high + fixed(1e-2L) + fixed(std::abs(mean) / kTicks));
        last = is;
      }
      if (last.velocity == 0 && end.velocity != 0) ++at_limits;
    }
  }
  EXPECT_GT(at_limits, 300);
  EXPECT_GT(stood, 100);
}

TEST(MotionAgain, AMotionToWhereItIsIsThereBeforeItBegins) {
  Trapezoid motion;
  motion.move(1'000, {fixed(5), 0}, fixed(900), {1'000, 1'000, 1'000});
  motion.move(50'000'000, {fixed(77), 0}, fixed(77), {1'000, 1'000, 1'000});
  for (const ProfileTicks t : {0, 49'999'999, 50'000'000, 60'000'000}) {
    EXPECT_EQ(motion.at(t).position, fixed(77));
    EXPECT_EQ(motion.at(t).velocity, 0);
  }
  EXPECT_FALSE(motion.cruises(10));
  motion.move(0, {0, 0}, fixed(900), {1'000, 1'000, 1'000});
  motion.hold(fixed(3));
  EXPECT_EQ(motion.phase_end(-10), motion.end()) << "nothing ends any more";
  EXPECT_EQ(motion.phase_end(10), motion.end());
}

}  // namespace
}  // namespace kinebus::testing_way

namespace kinebus::testing_bench {
namespace {

constexpr PlanCounts kFrom = 0xFFFF'F800;

PlanCounts counts_at(LocalTime from, LocalTime now) {
  return kFrom + static_cast<PlanCounts>((now - from) / kPlanCount);
}

TEST(MotionAgain, APlanIsOfAsManyPiecesAndAxesAsItIsAskedFor) {
  Lone lone;
  lone.start_move(1);
  MotionPlanExchange exchange;
  exchange.renew(lone.node, lone.now, kFrom, {.pieces = 4, .axes = 1});
  EXPECT_EQ(exchange.current().horizon(), 4 * MotionPlan::kPiece);
  EXPECT_EQ(exchange.current().at(1, kFrom + MotionPlan::kPiece).position, 0) << "nobody has asked for it";
  EXPECT_FALSE(exchange.outdated(lone.node, lone.now, kFrom));
  exchange.renew(lone.node, lone.now, kFrom, {.pieces = 6, .axes = 2});
  EXPECT_EQ(exchange.current().horizon(), 6 * MotionPlan::kPiece);
  EXPECT_NE(exchange.current().at(1, kFrom + MotionPlan::kPiece).position, 0);
}

TEST(MotionAgain, APlanIsGoodUntilItsEndAndNoLonger) {
  Lone lone;
  lone.start_move();
  lone.wait(50ms);
  MotionPlanExchange exchange;
  const LocalTime from = lone.now;
  exchange.renew(lone.node, from, kFrom);
  const LocalTime end = from + kPlanCount * MotionPlan::horizon(MotionPlan::kUsualPieces);
  for (; lone.now < end; lone.wait(100us))
    EXPECT_FALSE(exchange.outdated(lone.node, lone.now, counts_at(from, lone.now)))
        << (lone.now - from).count();
  EXPECT_TRUE(exchange.outdated(lone.node, end, counts_at(from, end)));
  EXPECT_TRUE(exchange.outdated(lone.node, end + 1ms, counts_at(from, end + 1ms)));
}

TEST(MotionAgain, AMotionEitherWayMakesAPlanOutdated) {
  for (const int way : {1, -1}) {
    Lone lone;
    EXPECT_EQ(lone.write(0x6060, 0, 1, 1), 0u);
    lone.power();
    lone.control(0x0F);
    MotionPlanExchange exchange;
    const LocalTime from = lone.now;
    exchange.renew(lone.node, from, kFrom);
    EXPECT_FALSE(exchange.outdated(lone.node, lone.now, counts_at(from, lone.now)));
    EXPECT_EQ(lone.write(0x607A, 0, 4, 50'000 * way), 0u);
    lone.control(0x1F);
    EXPECT_TRUE(exchange.outdated(lone.node, lone.now, counts_at(from, lone.now))) << way;
  }
}

TEST(MotionAgain, OfThreeMailboxesTheLeastUrgentMakesRoomAndOnlyForWhatIsMoreUrgent) {
  const auto frame = [](std::uint32_t id) { return CanFrame{.id = id, .length = 0}; };
  for (const int place : {0, 1, 2}) {
    TransmitQueue queue;
    for (int i = 0; i < 3; ++i) {
      queue.push(frame(i == place ? 0x300 : 0x100u + static_cast<unsigned>(i)));
      EXPECT_EQ(queue.next().kind, TransmitQueue::Action::Kind::kLoad);
    }
    queue.push(frame(0x301));
    EXPECT_EQ(queue.next().kind, TransmitQueue::Action::Kind::kNothing);
    queue.push(frame(0x200));
    const auto action = queue.next();
    EXPECT_EQ(action.kind, TransmitQueue::Action::Kind::kAbort);
    EXPECT_EQ(action.mailbox, place);
  }
}

}  // namespace
}  // namespace kinebus::testing_bench
