// What limits allow is reached, exactly and in time; and what they do not is approached as fast as they
// allow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "node_firmware/core/linear_interpolator.hpp"
#include "node_firmware/core/tests/interpolator_chance.hpp"

namespace kinebus::testing_way {
namespace {

TEST(LinearInterpolator, MeetsEveryStepOfASetPointThatGoesOnWithinTheLimits) {
  int faster_ways = 0, slower_ways = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Chance chance(seed);
    const auto limits = limits_of(chance, 0.2, 5);
    const long double up = limits.profile.acceleration, down = limits.profile.deceleration;
    const long double fastest = limits.profile.velocity;
    const auto period = static_cast<ProfileTicks>(chance.within(16'000, 320'000));
    const long double s = static_cast<long double>(period) / kTicks;
    const int sign = chance.sign();
    Trapezoid profile;
    LinearInterpolator line(profile);
    line.hold(fixed(chance.sign() * chance.within(1, 1000)));
    // The first step is approached as the only one.
    long double before = std::min(up, down) * s * s * 1e-3L;
    (void)line.go(0, line.at(0).position + sign * fixed(before), period, limits);
    ProfileTicks now = period;
    for (int i = 0; i < 40; ++i, now += period) {
      const ProfileState here = line.at(now);
      const long double v0 = sign * counts_per_s(here.velocity);
      // A ramp for a part of the period, and straight on: less than what the limits are.
      const bool faster = chance.of(3) != 0;
      const long double a = faster ? up : down, most = faster ? fastest - v0 : v0;
      const long double ramp =
          std::min(s, std::max(most, 0.0L) * 0.99L / a) * static_cast<long double>(chance.even());
      long double v1 = v0 + (faster ? a : -a) * ramp;
      long double way = v0 * s + (faster ? a : -a) * (ramp * s - ramp * ramp / 2) * 0.9999L;
      // To an end speed that the next step, as far as this one tells of it, can be met with.
      const long double mean = way / s, last = std::max((3 * way - before) / 2 / s, 0.0L);
      const bool fits = v1 > std::min(mean, last) - 0.24L * up * s &&
                        v1 < std::max(mean, last) + 0.24L * down * s && last > 0;
      const bool begins = !fits && v0 == 0;
      if (!fits) way = begins ? before : v0 * s, v1 = v0;
      if (3 * way <= before) break;  // it would be one to stop at
      const std::int64_t target = here.position + sign * fixed(way);
      SCOPED_TRACE(::testing::Message() << "seed " << seed << " " << i << " from " << v0 << " to " << v1);
      ASSERT_EQ(line.go(now, target, period, limits), 0);
      ASSERT_EQ(line.at(line.end()).position, target);
      ASSERT_EQ(line.end(), now + period);
      const long double end = sign * counts_per_s(line.at(line.end()).velocity);
      // Behind its end it goes on.
      ASSERT_NEAR(static_cast<double>(sign * counts(line.at(line.end() + 1600).position - target)),
                  static_cast<double>(end * 1e-4L), 1e-3);
      ++(way > before ? faster_ways : slower_ways);
      const bool slows = way < before;
      before = way;
      if (slows || begins) continue;
      // By the shortest ramp that does it, so that the end is as near to the way's mean speed as can be.
      ASSERT_NEAR(static_cast<double>(end), static_cast<double>(v1),
                  static_cast<double>(0.02L * a * s + 1e-3L * fastest + 2));
      for (int k = 0; k < 8; ++k) {
        const long double t = s * k / 8,
                          is = sign * counts(line.at(now + period * k / 8).position - here.position);
        const long double ramped = fits ? ramp : 0;
        const long double on = t < ramped ? t * t / 2 : ramped * t - ramped * ramped / 2;
        ASSERT_NEAR(static_cast<double>(is), static_cast<double>(v0 * t + (faster ? a : -a) * on),
                    static_cast<double>(0.02L * a * s * s + 1e-3L * fastest * s + 1e-3L));
      }
    }
  }
  EXPECT_GT(faster_ways, 4000);
  EXPECT_GT(slower_ways, 2000);
}

TEST(LinearInterpolator, AFarSetPointIsStoodAtNearlyAsSoonAsLimitsAllow) {
  int far = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    Chance chance(seed);
    const auto limits = limits_of(chance, 1, 5);
    const auto period = static_cast<ProfileTicks>(chance.within(16'000, 320'000));
    const long double s = static_cast<long double>(period) / kTicks, way = std::floor(chance.within(1, 1e5));
    const long double periods = least_time(way, limits.profile) / s;
    if (periods < 8 || periods > 2000) continue;
    ++far;
    const int sign = chance.sign();
    const std::int64_t from = fixed(chance.sign() * chance.within(1, 1000)),
                       target = from + sign * fixed(way);
    Trapezoid profile;
    LinearInterpolator line(profile);
    line.hold(from);
    ProfileTicks now = 0;
    long double beyond = 0;
    int n = 0;
    for (; n < 3000; ++n, now += period) {
      const std::int64_t behind = line.go(now, target, period, limits);
      if (line.done(now)) {
        ASSERT_EQ(behind, 0) << seed;
        ASSERT_EQ(line.at(now).velocity, 0) << seed;
        break;
      }
      ASSERT_NEAR(static_cast<double>(counts(behind)),
                  static_cast<double>(std::abs(counts(target - line.at(line.end()).position))), 1e-6)
          << seed;
      for (int k = 1; k <= 4; ++k)
        beyond = std::max(beyond, sign * counts(line.at(now + period * k / 4).position - target));
    }
    EXPECT_LE(n, 1.07L * periods + 2) << "seed " << seed << " of " << periods;
    EXPECT_LE(beyond, 1e-3L) << "seed " << seed;
    EXPECT_EQ(line.at(now).position, target) << seed;
    EXPECT_EQ(line.lost_at(), LinearInterpolator::kNever);
  }
  EXPECT_GT(far, 500);
}

TEST(LinearInterpolator, CatchesUpWithASetPointThatGoesOnAndStaysWithIt) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Chance chance(seed);
    const auto limits = limits_of(chance, 1, 2);
    const long double fastest = limits.profile.velocity, a = limits.profile.acceleration;
    const auto period = static_cast<ProfileTicks>(chance.within(16'000, 160'000));
    const long double s = static_cast<long double>(period) / kTicks;
    const int sign = chance.sign();
    const long double speed = fastest * chance.within(0.1, 0.8);
    if (fastest / a / s > 200) continue;
    Trapezoid profile;
    LinearInterpolator line(profile);
    line.hold(0);
    const int periods = static_cast<int>(10 * fastest / a / s) + 60;
    int reached = 0;
    std::int64_t target = 0;
    ProfileTicks now = 0;
    for (int n = 0; n < periods; ++n, now += period) {
      target += sign * fixed(speed * s);
      reached = line.go(now, target, period, limits) == 0 ? reached + 1 : 0;
    }
    ASSERT_GT(reached, 10) << "seed " << seed << " of " << periods;
    EXPECT_EQ(line.at(now).position, target) << seed;
    EXPECT_NEAR(static_cast<double>(counts_per_s(line.at(now).velocity)), static_cast<double>(sign * speed),
                static_cast<double>(0.01L * speed + 1));
    EXPECT_FALSE(line.done(now));
  }
}

TEST(LinearInterpolator, WaitsForASyncThatIsLateAndNoLonger) {
  const LinearInterpolator::Limits limits{{100'000, 100'000'000, 100'000'000}};
  const struct {
    ProfileTicks period, waits;
  } table[] = {{16'000, 24'000},   {160'000, 240'000}, {213'334, 320'000},
               {320'000, 320'000}, {640'000, 320'000}, {1'600'000, 800'000}};
  for (const auto& row : table) {
    Trapezoid profile;
    LinearInterpolator line(profile);
    line.hold(0);
    const ProfileTicks start = 500 + row.period;
    ASSERT_EQ(line.go(500, fixed(20), row.period, limits), 0);
    EXPECT_EQ(line.lost_at(), LinearInterpolator::kNever) << "it stops there";
    ASSERT_EQ(line.go(start, fixed(40), row.period, limits), 0);
    EXPECT_NEAR(static_cast<double>(line.lost_at()), static_cast<double>(start + row.period + row.waits), 2)
        << row.period;
    EXPECT_FALSE(line.done(start));
    EXPECT_EQ(line.at(0).position, fixed(20)) << "before its start";
  }
}

TEST(LinearInterpolator, SpeedsUpByOneLimitAndSlowsDownByTheOther) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Chance chance(seed);
    auto limits = limits_of(chance, 0.05, 20);
    if (chance.of(3) == 0) limits.high = fixed(chance.within(10, 1e4));
    const long double up = limits.profile.acceleration, down = limits.profile.deceleration;
    const long double fastest = limits.profile.velocity;
    const auto period = static_cast<ProfileTicks>(chance.within(16'000, 320'000));
    Trapezoid profile;
    LinearInterpolator line(profile);
    line.hold(0);
    std::int64_t target = 0;
    ProfileTicks now = 0, then = 0;
    ProfileState last = line.at(0);
    for (int i = 0; i < 60; ++i, now += period) {
      if (chance.of(3) != 0)
        target += chance.sign() * fixed(chance.within(0.01, 3) * static_cast<double>(fastest) *
                                        static_cast<double>(period) / 16e6);
      (void)line.go(now, std::min(target, limits.high), period, limits);
      for (int k = 1; k <= 32; ++k) {
        const ProfileTicks t = now + period * k / 32;
        const ProfileState state = line.at(t);
        const long double v0 = counts_per_s(last.velocity), v1 = counts_per_s(state.velocity);
        const long double dt = static_cast<long double>(t - then) / kTicks;
        // Through zero it slows down first, and then speeds up.
        const long double needs = v0 * v1 < 0                   ? std::abs(v0) / down + std::abs(v1) / up
                                  : std::abs(v1) > std::abs(v0) ? (std::abs(v1) - std::abs(v0)) / up
                                                                : (std::abs(v0) - std::abs(v1)) / down;
        ASSERT_LE(needs, dt * 1.001L + (1e-6L * fastest + 2) / std::min(up, down))
            << "seed " << seed << " " << i;
        ASSERT_LE(std::abs(v1), fastest * 1.0001L + 1) << "seed " << seed;
        last = state;
        then = t;
      }
    }
  }
}

}  // namespace
}  // namespace kinebus::testing_way
