// What limits allow is reached, exactly and in time; and what they do not is approached as fast as they
// allow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "node_firmware/core/linear_interpolator.hpp"

namespace kinebus::testing_way {
namespace {

constexpr long double kTicks = 16e6L;

std::int64_t fixed(long double counts) {
  return static_cast<std::int64_t>(std::ldexp(counts, 32));
}
long double counts(std::int64_t position) {
  return std::ldexp(static_cast<long double>(position), -32);
}
long double counts_per_s(std::int64_t velocity) {
  return std::ldexp(static_cast<long double>(velocity), -56) * kTicks;
}

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : random_(seed) {}
  std::uint64_t of(std::uint64_t n) { return random_() % n; }
  double even() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double within(double low, double high) { return low * std::pow(high / low, even()); }
  int sign() { return of(2) == 0 ? 1 : -1; }

 private:
  std::mt19937_64 random_;
};

LinearInterpolator::Limits limits_of(Chance& chance, double least_ratio, double most_ratio) {
  LinearInterpolator::Limits limits;
  const double a = chance.within(1e4, 1e8);
  limits.profile = {static_cast<std::uint32_t>(chance.within(1000, 1.6e6)), static_cast<std::uint32_t>(a),
                    static_cast<std::uint32_t>(a * chance.within(least_ratio, most_ratio))};
  return limits;
}

TEST(LinearInterpolator, ReachesExactlyWhatItsLimitsAllow) {
  int both_ways[2] = {0, 0}, reversed = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Chance chance(seed);
    const auto limits = limits_of(chance, 0.2, 5);
    const long double up = limits.profile.acceleration, down = limits.profile.deceleration;
    const long double fastest = limits.profile.velocity;
    const auto period = static_cast<ProfileTicks>(chance.within(16'000, 320'000));
    const long double s = static_cast<long double>(period) / kTicks;
    LinearInterpolator line;
    line.hold(fixed(chance.sign() * chance.within(1, 1000)));
    ProfileTicks now = 0;
    for (int i = 0; i < 40; ++i, now += period) {
      const ProfileState here = line.at(now);
      const long double v0 = counts_per_s(here.velocity);
      // A ramp for a part of the period, and straight on: less than what the limits are.
      const int sign = chance.sign();
      const bool faster = here.velocity == 0 || (v0 > 0) == (sign > 0);
      long double a = faster ? up : down;
      if (!faster && down * s > std::abs(v0)) a = std::min(up, down);
      const long double most = sign > 0 ? fastest - v0 : fastest + v0;
      const long double ramp =
          std::min(s, std::max(most, 0.0L) * 0.99L / a) * static_cast<long double>(chance.even());
      const long double v1 = v0 + sign * a * ramp;
      const long double way = v0 * s + sign * a * (ramp * s - ramp * ramp / 2) * 0.9999L;
      const std::int64_t target = here.position + fixed(way);
      SCOPED_TRACE(::testing::Message() << "seed " << seed << " " << i << " from " << v0 << " to " << v1);
      ASSERT_EQ(line.go(now, target, period, limits), 0);
      ASSERT_EQ(line.at(line.end()).position, target);
      ASSERT_EQ(line.end(), now + period);
      // By the shortest ramp that does it, so that the end is as slow as can be.
      const long double end = counts_per_s(line.at(line.end()).velocity);
      ASSERT_NEAR(static_cast<double>(end), static_cast<double>(v1),
                  static_cast<double>(0.02L * a * s + 1e-3L * fastest + 2));
      for (int k = 0; k < 8; ++k) {
        const long double t = s * k / 8, is = counts(line.at(now + period * k / 8).position - here.position);
        const long double on = t < ramp ? sign * a * t * t / 2 : sign * a * (ramp * t - ramp * ramp / 2);
        ASSERT_NEAR(static_cast<double>(is), static_cast<double>(v0 * t + on),
                    static_cast<double>(0.02L * a * s * s + 1e-3L * fastest * s + 1e-3L));
      }
      // Behind its end it goes on.
      ASSERT_NEAR(static_cast<double>(counts(line.at(line.end() + 1600).position - target)),
                  static_cast<double>(end * 1e-4L), 1e-3);
      ++both_ways[sign > 0];
      reversed += v0 * v1 < 0;
    }
  }
  EXPECT_GT(std::min(both_ways[0], both_ways[1]), 4000);
  EXPECT_GT(reversed, 300);
}

/// The least time from rest to rest, s.
long double least_time(long double way, const ProfileLimits& limits) {
  const long double v = limits.velocity, a = limits.acceleration, d = limits.deceleration;
  const long double peak = std::sqrt(2 * way * a * d / (a + d));
  if (peak <= v) return peak / a + peak / d;
  return v / a + v / d + (way - v * v / 2 / a - v * v / 2 / d) / v;
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
    LinearInterpolator line;
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
    const long double down = limits.profile.deceleration;
    EXPECT_LE(n, 1.01L * periods + 14 + 2 * std::sqrt(periods)) << "seed " << seed << " of " << periods;
    EXPECT_LE(beyond, 4 * down * s * s + 1e-3L) << "seed " << seed;
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
    LinearInterpolator line;
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

TEST(LinearInterpolator, SetPointsThatRunIntoALimitLeadOutOfItByAPeriodsWayAtMost) {
  int braked = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    Chance chance(seed);
    auto limits = limits_of(chance, 1, 3);
    const auto period = static_cast<ProfileTicks>(chance.within(16'000, 160'000));
    const long double s = static_cast<long double>(period) / kTicks, room = chance.within(50, 1e5);
    const int sign = chance.sign();
    (sign > 0 ? limits.high : limits.low) = sign * fixed(room);
    const long double speed = limits.profile.velocity * chance.within(0.05, 1.5);
    if (room / speed / s > 2000 || least_time(room, limits.profile) / s > 2000) continue;
    LinearInterpolator line;
    line.hold(0);
    ProfileTicks now = 0;
    long double set_point = 0;
    for (int n = 0; n < 2500; ++n, now += period) {
      set_point = std::min(set_point + speed * s, room);
      line.go(now, sign * fixed(set_point), period, limits);
      for (int k = 1; k <= 4; ++k)
        ASSERT_LE(sign * counts(line.at(now + period * k / 4).position),
                  room + 1.05L * limits.profile.velocity * s)
            << "seed " << seed;
    }
    EXPECT_EQ(line.at(now).position, sign * fixed(room)) << seed;
    EXPECT_EQ(line.at(now).velocity, 0) << seed;
    ++braked;
  }
  EXPECT_GT(braked, 80);
}

TEST(LinearInterpolator, WaitsForASyncThatIsLateAndNoLonger) {
  const LinearInterpolator::Limits limits{{100'000, 100'000'000, 100'000'000}};
  const struct {
    ProfileTicks period, waits;
  } table[] = {{16'000, 24'000},   {160'000, 240'000}, {213'334, 320'000},
               {320'000, 320'000}, {640'000, 320'000}, {1'600'000, 800'000}};
  for (const auto& row : table) {
    LinearInterpolator line;
    line.hold(0);
    ASSERT_EQ(line.go(500, fixed(20), row.period, limits), 0);
    EXPECT_NEAR(static_cast<double>(line.lost_at()), static_cast<double>(500 + row.period + row.waits), 2)
        << row.period;
    EXPECT_FALSE(line.done(500));
    EXPECT_EQ(line.at(0).position, 0) << "before its start";
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
    LinearInterpolator line;
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
