// Any set-points, periods and limits: the way between them is continuous, and never faster or steeper than
// allowed.
#include "node_firmware/core/linear_interpolator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kinebus {
namespace {

constexpr double kPerSecond = static_cast<double>(kTicksPerSecond);

double speed_of(const ProfileState& state) {  // counts/s
  return static_cast<double>(state.velocity) * 0x1p-56 * kPerSecond;
}
double counts_of(std::int64_t position) {
  return static_cast<double>(position) * 0x1p-32;
}

TEST(LinearInterpolator, KeepsItsLimitsWhateverIsAskedOfIt) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    std::mt19937_64 random(seed);
    const auto within = [&](double low, double high) {  // evenly by magnitude
      const double even = static_cast<double>(random() >> 11) * 0x1p-53;
      return std::exp(std::log(low) + even * (std::log(high) - std::log(low)));
    };
    Trapezoid profile;
    LinearInterpolator line(profile);
    LinearInterpolator::Limits limits;
    limits.profile = {static_cast<std::uint32_t>(within(100, 1.6e7)),
                      static_cast<std::uint32_t>(within(1e4, 4.2e9)),
                      static_cast<std::uint32_t>(within(1e4, 4.2e9))};
    const double speed = limits.profile.velocity;
    const double steepest = std::max(limits.profile.acceleration, limits.profile.deceleration);
    const auto period = static_cast<ProfileTicks>(within(1'600, 1.6e7));
    line.hold(0);
    ProfileTicks now = 0;
    ProfileState last = line.at(now);
    std::int64_t target = 0;
    for (int i = 0; i < 60; ++i) {
      // Far jumps, small steps, and the same set-point again; SYNC a little early or late.
      const std::uint64_t kind = random() % 4;
      const double far = kind == 0   ? within(1, 1e9)
                         : kind == 1 ? within(0.01, 2) * speed * static_cast<double>(period) / kPerSecond
                                     : 0;
      target += from_counts(static_cast<std::int64_t>(random() % 2 == 0 ? far : -far));
      target = std::clamp(target, -kPositionBound, kPositionBound);
      const std::int64_t behind = line.go(now, target, period, limits);
      ASSERT_GE(behind, 0) << seed;
      // A ramp may be shorter than a tick.
      EXPECT_NEAR(speed_of(line.at(now)), speed_of(last), steepest / kPerSecond + 1e-3) << seed;
      EXPECT_NEAR(counts_of(line.at(now).position), counts_of(last.position), 1e-6) << seed;
      const ProfileTicks length = period + static_cast<ProfileTicks>(random() % 3) * period / 8 - period / 8;
      constexpr int kSamples = 16;
      ProfileTicks then = now;
      for (int k = 1; k <= kSamples; ++k) {
        const ProfileTicks t = now + length * k / kSamples;
        const ProfileState state = line.at(t);
        const double dt = static_cast<double>(t - then) / kPerSecond;
        ASSERT_LE(std::abs(speed_of(state)), speed * 1.001 + 30) << seed << " " << i;
        ASSERT_LE(std::abs(speed_of(state) - speed_of(last)), steepest * dt * 1.001 + speed * 1e-3 + 30)
            << seed << " " << i;
        const double way = counts_of(state.position) - counts_of(last.position);
        ASSERT_LE(std::abs(way), (speed * 1.001 + 30) * dt + 1e-3) << seed << " " << i;
        last = state;
        then = t;
      }
      if (behind == 0) {
        EXPECT_EQ(line.at(line.end()).position, target) << seed;
      }
      now += length;
    }
  }
}

TEST(LinearInterpolator, StandsBetweenEqualSetPointsAndIsNeverLostThen) {
  Trapezoid profile;
  LinearInterpolator line(profile);
  line.hold(from_counts(5));
  const LinearInterpolator::Limits limits{{1000, 1000, 1000}};
  EXPECT_EQ(line.go(100, from_counts(5), 1600, limits), 0);
  EXPECT_TRUE(line.done(100));
  EXPECT_EQ(line.lost_at(), LinearInterpolator::kNever);
  EXPECT_EQ(line.at(1'000'000).position, from_counts(5));
}

}  // namespace
}  // namespace kinebus
