#include "node_firmware/core/trapezoid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace kinebus {
namespace {

double counts(std::int64_t position) {
  return std::ldexp(static_cast<double>(position), -32);
}
double counts_per_s(std::int64_t velocity) {
  return std::ldexp(static_cast<double>(velocity), -56) * 16e6;
}

/// Walks over the whole motion and checks what may never happen: steps, speed or acceleration above the
/// limits.
struct Walk {
  double max_speed = 0;
  double max_acceleration = 0;
  double max_deceleration = 0;
  double max_jump_counts = 0;  // position against the integral of velocity
};
/// How far position moves beyond what any velocity between t0 and t1 explains; a corner of the velocity
/// inside is looked at ever closer, down to one tick.
double jump(const Trapezoid& motion, ProfileTicks t0, ProfileTicks t1) {
  const ProfileState a = motion.at(t0), b = motion.at(t1);
  const double dt = static_cast<double>(t1 - t0) / 16e6;
  const double moved = counts(b.position - a.position);
  const double v0 = counts_per_s(a.velocity), v1 = counts_per_s(b.velocity);
  const double excess = std::max(moved - std::max(v0, v1) * dt, std::min(v0, v1) * dt - moved);
  if (excess < 1e-5 || t1 - t0 == 1) return excess;
  const ProfileTicks middle = t0 + (t1 - t0) / 2;
  return std::max(jump(motion, t0, middle), jump(motion, middle, t1));
}
Walk walk(const Trapezoid& motion, ProfileTicks start) {
  Walk result;
  const ProfileTicks length = motion.end() - start;
  const ProfileTicks step = std::max<ProfileTicks>(length / 2000, 1);
  ProfileState last = motion.at(start);
  for (ProfileTicks t = start + step; t <= motion.end(); t += step) {
    const ProfileState now = motion.at(t);
    const double dt = static_cast<double>(step) / 16e6;
    const double v0 = counts_per_s(last.velocity), v1 = counts_per_s(now.velocity);
    const double slope = (std::abs(v1) - std::abs(v0)) / dt;
    result.max_speed = std::max(result.max_speed, std::abs(v1));
    if (v0 * v1 >= 0) {
      result.max_acceleration = std::max(result.max_acceleration, slope);
      result.max_deceleration = std::max(result.max_deceleration, -slope);
    }
    result.max_jump_counts = std::max(result.max_jump_counts, jump(motion, t - step, t));
    last = now;
  }
  return result;
}

ProfileTicks seconds(double s) {
  return static_cast<ProfileTicks>(s * 16e6);
}

TEST(FixedPoint, TicksAreExactWithoutADivision) {
  std::mt19937_64 random(125);
  for (int i = 0; i < 200'000; ++i) {
    const auto ns =
        static_cast<std::int64_t>(random() >> (3 + random() % 60)) * ((i & 1) != 0 ? 1 : -1) + i % 3 - 1;
    if (ns > (std::int64_t{1} << 60) || ns < -(std::int64_t{1} << 60)) continue;
    const std::int64_t down = (ns * 2 - (ns < 0 ? 124 : 0)) / 125;
    ASSERT_EQ(to_ticks(LocalTime{ns}), down) << ns;
  }
}

TEST(Trapezoid, FullSpeedMotionTakesTheTextbookTimeAndEndsExactly) {
  Trapezoid motion;
  motion.move(1000, {0, 0}, from_counts(256'000), {128'000, 1'280'000, 640'000});
  EXPECT_EQ(motion.at(motion.end()).position, from_counts(256'000));
  EXPECT_EQ(motion.at(motion.end()).velocity, 0);
  // 0.1 s and 6400 counts up, 0.2 s and 12800 counts down, the rest at speed.
  EXPECT_NEAR(static_cast<double>(motion.end() - 1000) / 16e6, 0.1 + 0.2 + (256'000 - 19'200) / 128'000.0,
              0.001);
  const Walk w = walk(motion, 1000);
  EXPECT_NEAR(w.max_speed, 128'000, 2);
  EXPECT_LT(w.max_jump_counts, 1e-4);
}

TEST(Trapezoid, RandomMotionsKeepTheirLimitsAndNeverStep) {
  std::mt19937_64 random(1);
  const auto log_uniform = [&](double low, double high) {
    return static_cast<std::uint32_t>(
        std::exp(std::uniform_real_distribution<>(std::log(low), std::log(high))(random)));
  };
  for (int i = 0; i < 400; ++i) {
    const ProfileLimits limits{log_uniform(10, 1e6), log_uniform(1000, 1e7), log_uniform(1000, 1e7)};
    const auto target = static_cast<std::int64_t>(log_uniform(1, 4e6)) * (random() % 2 == 0 ? 1 : -1);
    Trapezoid motion;
    ProfileState from{static_cast<std::int64_t>(random() % 1000) * kOneCount / 7, 0};
    ProfileTicks start = static_cast<ProfileTicks>(random() % 1'000'000);
    motion.move(start, from, from_counts(target), limits);
    SCOPED_TRACE(testing::Message() << "motion " << i << " v " << limits.velocity << " a "
                                    << limits.acceleration << " d " << limits.deceleration << " to "
                                    << target);
    const auto check = [&](const ProfileLimits& l, double entry_speed) {
      const Walk w = walk(motion, start);
      EXPECT_LE(w.max_speed, std::max<double>(l.velocity, entry_speed) + 1);
      const double braking = 1 + std::max(l.acceleration, l.deceleration) * 1.0001;
      EXPECT_LE(w.max_acceleration, l.acceleration * 1.0001 + 1);
      EXPECT_LE(w.max_deceleration, braking);
      EXPECT_LT(w.max_jump_counts, 1e-4);
      EXPECT_EQ(motion.at(motion.end()).velocity, 0);
    };
    check(limits, 0);
    EXPECT_EQ(motion.at(motion.end()).position, from_counts(target));

    // A new target, new limits, in the middle of the motion: no step where they meet.
    const ProfileTicks middle =
        start + static_cast<ProfileTicks>(random() % static_cast<unsigned long>(motion.end() - start));
    const ProfileState state = motion.at(middle);
    const ProfileLimits changed{log_uniform(10, 1e6), log_uniform(1000, 1e7), log_uniform(1000, 1e7)};
    const auto second = static_cast<std::int64_t>(log_uniform(1, 4e6)) * (random() % 2 == 0 ? 1 : -1);
    motion.move(middle, state, from_counts(second), changed);
    start = middle;
    EXPECT_LE(std::abs(counts(motion.at(middle).position - state.position)), 1e-4);
    EXPECT_LE(std::abs(counts_per_s(motion.at(middle).velocity - state.velocity)), 0.1);
    check(changed, std::abs(counts_per_s(state.velocity)));
    EXPECT_EQ(motion.at(motion.end()).position, from_counts(second));
  }
}

TEST(Trapezoid, SameTargetAgainInTheMiddleDoesNotOvershoot) {
  const ProfileLimits limits{128'000, 1'280'000, 640'000};
  for (int percent = 1; percent < 100; percent += 3) {
    Trapezoid motion;
    motion.move(0, {0, 0}, from_counts(60'000), limits);
    const ProfileTicks middle = motion.end() / 100 * percent;
    motion.move(middle, motion.at(middle), from_counts(60'000), limits);
    for (ProfileTicks t = middle; t <= motion.end(); t += 1600)
      ASSERT_LE(motion.at(t).position, from_counts(60'000)) << percent << " %";
    EXPECT_EQ(motion.at(motion.end()).position, from_counts(60'000));
  }
}

TEST(Trapezoid, StopEndsOnAWholeCountWithinTheRampAndOneCount) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    Trapezoid motion;
    const ProfileLimits limits{400'000, 2'000'000, 2'000'000};
    motion.move(0, {0, 0}, from_counts(random() % 2 == 0 ? 900'000 : -900'000), limits);
    const ProfileTicks middle =
        static_cast<ProfileTicks>(random() % static_cast<unsigned long>(motion.end()));
    const ProfileState state = motion.at(middle);
    motion.stop(middle, state, 6'400'000);
    const double v = counts_per_s(state.velocity);
    const std::int64_t end = motion.at(motion.end()).position;
    EXPECT_EQ(end % kOneCount, 0);
    const double distance = std::abs(counts(end - state.position));
    EXPECT_NEAR(distance, v * v / 2 / 6.4e6, 1.01);
    const Walk w = walk(motion, middle);
    EXPECT_LE(w.max_deceleration, 6.4e6 * 1.0001);
    EXPECT_LT(w.max_jump_counts, 1e-4);
  }
}

TEST(Trapezoid, PassReachesItsTargetAtSpeed) {
  Trapezoid motion;
  motion.pass(0, {0, 0}, from_counts(100'000), {128'000, 1'280'000, 1'280'000});
  const ProfileState end = motion.at(motion.end());
  EXPECT_EQ(end.position, from_counts(100'000));
  EXPECT_NEAR(counts_per_s(end.velocity), 128'000, 2);
  EXPECT_LT(walk(motion, 0).max_jump_counts, 1e-4);
  EXPECT_LT(motion.end(), seconds(1));
}

TEST(Trapezoid, ExtremeNumbersStillEndAtTheTarget) {
  const std::array<std::uint32_t, 4> sizes{1, 50, 1'000'000, 0xFFFF'FFFFu};
  for (const std::uint32_t v : sizes)
    for (const std::uint32_t a : sizes)
      for (const std::int64_t target : {1L, 1000L, (1L << 30) - 1}) {
        Trapezoid motion;
        motion.move(0, {-kPositionBound, 0}, from_counts(target), {v, a, a});
        EXPECT_EQ(motion.at(motion.end()).position, from_counts(target)) << v << " " << a;
        const ProfileTicks middle = motion.end() / 2;
        motion.move(middle, motion.at(middle), from_counts(-target), {v, a, a});
        EXPECT_EQ(motion.at(motion.end()).position, from_counts(-target)) << v << " " << a;
      }
}

TEST(FixedPoint, LocalTimeAndTicksMeetOnTheirCommonGrid) {
  EXPECT_EQ(to_ticks(LocalTime{125}), 2);
  EXPECT_EQ(to_ticks(LocalTime{124}), 1);
  EXPECT_EQ(to_ticks(LocalTime{-1}), -1);
  for (ProfileTicks t = -5; t < 50; ++t) EXPECT_EQ(to_ticks(to_local(t)), t);
}

TEST(FixedPoint, SquareRootIsTheLargestThatFits) {
  for (std::uint64_t v : {0ull, 1ull, 3ull, 4ull, 1ull << 40, (1ull << 62) - 1}) {
    const std::uint64_t r = square_root(v);
    EXPECT_LE(r * r, v);
    EXPECT_GT((r + 1) * (r + 1), v);
  }
}

}  // namespace
}  // namespace kinebus
