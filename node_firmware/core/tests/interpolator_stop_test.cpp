// Where set-points stop, the axis does: a step, a jump, the end of a master's ramp or a limit of the travel
// is not passed, whatever the two limits of acceleration are and however late SYNC is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "node_firmware/core/linear_interpolator.hpp"
#include "node_firmware/core/tests/interpolator_chance.hpp"

namespace kinebus::testing_way {
namespace {

/// How far the axis is beyond `target`, seen in the direction `sign`, at most, in the period from `now`.
long double beyond(const LinearInterpolator& line, ProfileTicks now, ProfileTicks period, int sign,
                   std::int64_t target) {
  long double most = -1e18L;
  for (int k = 1; k <= 16; ++k)
    most = std::max(most, sign * counts(line.at(now + period * k / 16).position - target));
  return most;
}

constexpr long double kNothing = 0.01L;  // counts

TEST(LinearInterpolator, AStepWithinAPeriodIsStoodAtWhereItIsAskedFor) {
  int in_time = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    Chance chance(seed);
    const auto limits = limits_of(chance, 0.05, 20);
    const auto period = static_cast<ProfileTicks>(chance.within(16'000, 320'000));
    const long double s = static_cast<long double>(period) / kTicks;
    const long double slowest = std::min(limits.profile.acceleration, limits.profile.deceleration);
    const int sign = chance.sign();
    const std::int64_t from = fixed(chance.sign() * chance.within(1, 1000));
    const long double most = std::min<long double>(slowest * s / 2, limits.profile.velocity) * s;
    const std::int64_t target = from + sign * fixed(most * chance.within(0.001, 1));
    Trapezoid profile;
    LinearInterpolator line(profile);
    line.hold(from);
    (void)line.go(0, from, period, limits);
    ProfileTicks now = period;
    for (int n = 0; n < 40; ++n, now += period) {
      const std::int64_t behind = line.go(now, target, period, limits);
      ASSERT_LE(beyond(line, now, period, sign, target), kNothing) << "seed " << seed << " period " << n;
      if (n > 0) continue;
      const bool can = least_time(counts(std::abs(target - from)), limits.profile) < 0.99L * s - 4e-4L;
      in_time += can;
      if (!can) continue;
      EXPECT_EQ(behind, 0) << seed;
      EXPECT_EQ(line.at(line.end()).velocity, 0) << seed;
    }
    EXPECT_EQ(line.at(now).position, target) << seed;
    EXPECT_TRUE(line.done(now)) << seed;
  }
  EXPECT_GT(in_time, 500);
}

TEST(LinearInterpolator, AJumpDoesNotSwingWhateverTheRatioOfItsLimits) {
  int far = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    Chance chance(seed);
    const auto limits = limits_of(chance, 0.03, 30);
    const auto period = static_cast<ProfileTicks>(chance.within(16'000, 320'000));
    const long double s = static_cast<long double>(period) / kTicks, way = std::floor(chance.within(1, 1e5));
    const long double periods = least_time(way, limits.profile) / s;
    if (periods > 2000) continue;
    ++far;
    const int sign = chance.sign();
    const std::int64_t target = sign * fixed(way);
    Trapezoid profile;
    LinearInterpolator line(profile);
    line.hold(0);
    ProfileTicks now = 0;
    int n = 0;
    for (; n < 3000; ++n, now += period) {
      (void)line.go(now, target, period, limits);
      if (line.done(now)) break;
      ASSERT_LE(beyond(line, now, period, sign, target), kNothing) << "seed " << seed << " period " << n;
    }
    EXPECT_LE(n, 1.08L * periods + 2)
        << "seed " << seed << " of " << periods;  // a trapezoid tries in sixteenths
    EXPECT_EQ(line.at(now).position, target) << seed;
  }
  EXPECT_GT(far, 1000);
}

/// Where a master that keeps to a share of the limits puts its set-points: from rest to rest. None: its
/// brakes take less than two periods, so that no step tells of the one that is none.
std::vector<std::int64_t> way_of_master(long double way, const ProfileLimits& limits, long double period_s,
                                        long double phase) {
  const long double up = limits.acceleration, down = limits.deceleration, fastest = limits.velocity;
  const long double peak = std::min(fastest, std::sqrt(2 * way * up * down / (up + down)));
  const long double t1 = peak / up, t3 = peak / down;
  if (t3 < 2 * period_s) return {};
  const long double t2 = std::max((way - peak * t1 / 2 - peak * t3 / 2) / peak, 0.0L);
  std::vector<std::int64_t> points;
  for (long double t = phase * period_s; t < t1 + t2 + t3; t += period_s) {
    const long double left = t1 + t2 + t3 - t;
    const long double at = t < t1      ? up * t * t / 2
                           : left > t3 ? peak * t1 / 2 + peak * (t - t1)
                                       : way - down * left * left / 2;
    points.push_back(fixed(at));
  }
  points.push_back(fixed(way));
  return points;
}

TEST(LinearInterpolator, FollowsAMasterThatPlansWithinHalfOfItsLimitsAndStopsWhereItStops) {
  int ways = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    Chance chance(seed);
    const auto limits = limits_of(chance, 0.5, 2);
    const auto share = [&](std::uint32_t limit) {
      return static_cast<std::uint32_t>(limit * chance.within(0.05, 0.5));
    };
    const ProfileLimits its{share(limits.profile.velocity), share(limits.profile.acceleration),
                            share(limits.profile.deceleration)};
    const auto period = static_cast<ProfileTicks>(chance.within(16'000, 320'000));
    const long double s = static_cast<long double>(period) / kTicks;
    const auto points = way_of_master(std::floor(chance.within(100, 1e5)), its, s, chance.even());
    if (points.size() < 8 || points.size() > 2000) continue;
    ++ways;
    Trapezoid profile;
    LinearInterpolator line(profile);
    line.hold(0);
    ProfileTicks now = 0;
    (void)line.go(now, 0, period, limits);
    int late = 0;
    for (const std::int64_t point : points) {
      now += period;
      late += line.go(now, point, period, limits) != 0;
    }
    // Its first step may have been the only one, so that the next ones have to catch up.
    EXPECT_LE(late, 3) << "seed " << seed << " of " << points.size();
    for (int n = 0; n < 4; ++n) {
      ASSERT_LE(beyond(line, now, period, 1, points.back()), 0.05L) << "seed " << seed << " " << n;
      now += period;
      (void)line.go(now, points.back(), period, limits);
    }
    EXPECT_EQ(line.at(now).position, points.back()) << seed;
    EXPECT_TRUE(line.done(now)) << seed;
  }
  EXPECT_GT(ways, 1000);
}

TEST(LinearInterpolator, SetPointsThatRunIntoALimitDoNotLeadOutOfItNorDoesASyncThatIsLateOrLost) {
  int braked = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Chance chance(seed);
    auto limits = limits_of(chance, 0.2, 5);
    const auto period = static_cast<ProfileTicks>(chance.within(16'000, 160'000));
    const long double s = static_cast<long double>(period) / kTicks, room = chance.within(50, 1e5);
    const int sign = chance.sign();
    (sign > 0 ? limits.high : limits.low) = sign * fixed(room);
    const long double speed = limits.profile.velocity * chance.within(0.05, 1.5);
    if (room / speed / s > 2000 || least_time(room, limits.profile) / s > 2000) continue;
    Trapezoid profile;
    LinearInterpolator line(profile);
    line.hold(0);
    ProfileTicks now = 0;
    long double set_point = 0;
    for (int n = 0; n < 2500; ++n) {
      set_point = std::min(set_point + speed * s, room);
      (void)line.go(now, sign * fixed(set_point), period, limits);
      const ProfileTicks until = std::min(line.lost_at(), line.end() + 2 * period) - now;
      ASSERT_LE(beyond(line, now, until, sign, sign * fixed(room)), kNothing) << "seed " << seed << " " << n;
      now += period + (chance.of(8) == 0 ? period * static_cast<ProfileTicks>(chance.of(5)) / 4 : 0);
    }
    EXPECT_EQ(line.at(now).position, sign * fixed(room)) << seed;
    EXPECT_EQ(line.at(now).velocity, 0) << seed;
    ++braked;
  }
  EXPECT_GT(braked, 500);
}

}  // namespace
}  // namespace kinebus::testing_way
