// Against the exact times and limits, in wide numbers: no motion is slower than its limits make it, and none
// leaves them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "node_firmware/core/trapezoid.hpp"

namespace kinebus::testing_times {
namespace {

__extension__ using Wide = __int128;

constexpr long double kTicks = 16e6L;

std::int64_t fixed(long double counts) {
  return static_cast<std::int64_t>(std::ldexp(counts, 32));
}
std::int64_t velocity_of(long double counts_per_s) {
  return static_cast<std::int64_t>(std::ldexp(counts_per_s / kTicks, 56));
}

struct Asked {
  long double way = 0;  ///< counts, >= 0: the way in which it may go as well is the mirror image
  long double v0 = 0;   ///< counts/s, below 0: away from the target
  ProfileLimits limits;
  bool to_rest = true;
};

/// The least time that the limits leave, s.
long double least_time(const Asked& m) {
  const long double v = m.limits.velocity, a = m.limits.acceleration, d = m.limits.deceleration;
  const long double v0 = m.v0, brake = v0 * v0 / 2 / d;
  if (v0 < 0) return -v0 / d + least_time({m.way + brake, 0, m.limits, true});
  if (m.to_rest && brake > m.way) return v0 / d + least_time({brake - m.way, 0, m.limits, true});
  const long double down = m.to_rest ? v * v / 2 / d : 0, rest = m.to_rest ? v / d : 0;
  if (v0 > v) {
    const long double slower = (v0 * v0 - v * v) / 2 / d;
    if (slower > m.way) return (v0 - std::sqrt(v0 * v0 - 2 * d * m.way)) / d;
    return (v0 - v) / d + (m.way - slower - down) / v + rest;
  }
  const long double peak =
      m.to_rest ? std::sqrt((2 * m.way * a * d + d * v0 * v0) / (a + d)) : std::sqrt(2 * m.way * a + v0 * v0);
  if (peak <= v) return (peak - v0) / a + (m.to_rest ? peak / d : 0);
  return (v - v0) / a + (m.way - (v * v - v0 * v0) / 2 / a - down) / v + rest;
}

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : random_(seed) {}
  std::uint64_t of(std::uint64_t n) { return random_() % n; }
  /// Evenly by magnitude.
  double within(double low, double high) {
    const double even = static_cast<double>(random_() >> 11) * 0x1p-53;
    return std::exp(std::log(low) + even * (std::log(high) - std::log(low)));
  }
  ProfileLimits limits() {
    const double a = within(1000, 1e8);
    return {static_cast<std::uint32_t>(within(10, 1.6e7)), static_cast<std::uint32_t>(a),
            static_cast<std::uint32_t>(a * within(1.0 / 30, 30))};
  }
  Asked motion() {
    Asked m{within(1, 1e7), 0, limits(), of(3) != 0};
    switch (of(4)) {
      case 0:
        m.v0 = within(1, 1e6);
        break;
      case 1:
        m.v0 = -within(1, 1e6);
        break;
      case 2:  // brakes to rest there nearly as late as it may
        m.v0 = std::min<long double>(
            0.7L * m.limits.velocity,
            std::sqrt(2 * m.limits.deceleration * m.way) * (1 - 1e-4L * static_cast<long double>(of(20))));
        break;
      default:
        break;
    }
    return m;
  }

 private:
  std::mt19937_64 random_;
};

ProfileState start_of(const Asked& m, std::int64_t from, int sign) {
  return {from, sign * velocity_of(m.v0)};
}
void go(Trapezoid& motion, ProfileTicks start, const ProfileState& from, std::int64_t target,
        const Asked& m) {
  if (m.to_rest)
    motion.move(start, from, target, m.limits);
  else
    motion.pass(start, from, target, m.limits);
}

/// Each phase's change of speed against its limit, and its way against its speeds: to the last bit and 1e-6
/// counts.
void expect_within(const Trapezoid& motion, ProfileTicks start, const ProfileState& from,
                   const ProfileLimits& limits) {
  ASSERT_EQ(motion.at(start).velocity, from.velocity);
  ASSERT_EQ(motion.at(start).position, from.position);
  ASSERT_EQ(motion.at(start - 7).position, from.position) << "before its start it is there";
  const std::int64_t fastest = std::max(velocity_from(limits.velocity), std::abs(from.velocity));
  ProfileTicks t = start;
  for (int phase = 0; phase < 5 && !motion.done(t); ++phase) {
    const ProfileTicks end = motion.phase_end(t);
    ASSERT_GT(end, t);
    // Its last tick belongs to it; where it ends, the next one goes on.
    const ProfileState a = motion.at(t), b = motion.at(end - 1), next = motion.at(end);
    const bool faster = std::abs(b.velocity) > std::abs(a.velocity);
    const std::int64_t limit = acceleration_from(faster ? limits.acceleration : limits.deceleration);
    const Wide change = static_cast<Wide>(b.velocity) - a.velocity;
    ASSERT_LE((change < 0 ? -change : change) * 16, static_cast<Wide>(limit) * (end - 1 - t) + 16) << phase;
    ASSERT_LE(std::abs(a.velocity), fastest) << phase;
    ASSERT_LE(std::abs(next.velocity), fastest) << phase;
    ASSERT_EQ(motion.cruises(t), a.velocity == motion.at(t + (end - 1 - t) / 2).velocity &&
                                     a.velocity == b.velocity && a.velocity == motion.at(t + 1).velocity)
        << phase;
    const ProfileTicks middle = t + (end - 1 - t) / 2;
    for (const ProfileTicks to : {middle, end - 1}) {
      const ProfileState s = motion.at(to);
      const Wide twice = (static_cast<Wide>(a.velocity) + s.velocity) * (to - t);
      const Wide way = (static_cast<Wide>(s.position) - a.position) << 25;
      ASSERT_LE(std::abs(static_cast<double>(way - twice)), std::ldexp(1e-4, 57)) << phase;
    }
    // Where two meet: no step, but for what the last bit of a speed and of a ramp make in so long a time.
    const auto ticks = static_cast<long double>(end - t), changed = static_cast<long double>(change);
    ASSERT_LE(std::abs(static_cast<long double>(next.position - b.position)),
              std::ldexp(1e-4L, 32) + static_cast<long double>(fastest) * 0x1p-24L + ticks * 0x1p-23L +
                  std::abs(changed) * ticks * ticks * 0x1p-85L)
        << phase;
    t = end;
  }
  ASSERT_TRUE(motion.done(t));
}

TEST(Trapezoid, NoMotionIsSlowerThanItsLimitsMakeIt) {
  double sum = 0;
  int counted = 0;
  for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
    Chance chance(seed);
    const Asked m = chance.motion();
    // Its way back may be farther than an axis can go.
    if (m.v0 * m.v0 / 2 / m.limits.deceleration > 0x1p29L) continue;
    const int sign = chance.of(2) == 0 ? 1 : -1;
    const auto from = start_of(m, fixed(static_cast<long double>(chance.of(1000)) / 7), sign);
    const std::int64_t target = from.position + sign * fixed(m.way);
    const auto start = static_cast<ProfileTicks>(chance.of(1'000'000));
    Trapezoid motion;
    go(motion, start, from, target, m);
    SCOPED_TRACE(::testing::Message() << "seed " << seed << " way " << m.way << " from " << m.v0 << " limits "
                                      << m.limits.velocity << " " << m.limits.acceleration << " "
                                      << m.limits.deceleration << (m.to_rest ? " rests" : " passes"));
    expect_within(motion, start, from, m.limits);
    if (HasFatalFailure()) return;
    ASSERT_EQ(motion.at(motion.end()).position, target);
    ASSERT_EQ(motion.target(), target);
    const bool rests = motion.at(motion.end()).velocity == 0;
    if (m.to_rest || m.v0 < 0) {
      ASSERT_TRUE(rests);
    }
    const long double least = least_time({m.way, m.v0, m.limits, rests});
    const long double takes = static_cast<long double>(motion.end() - start) / kTicks;
    // A sixteenth, where the first estimate was too fast; ramps are 100 us at least.
    ASSERT_LE(takes, 1.066L * least + 200e-6L);
    // Who is too fast comes down a little late, and gains by it.
    if (m.v0 <= m.limits.velocity) {
      ASSERT_GE(takes, 0.9999L * least - 1e-6L);
    }
    if (least < 0.01L) continue;
    sum += static_cast<double>(takes / least);
    ++counted;
  }
  EXPECT_GT(counted, 2500);
  EXPECT_LE(sum / counted, 1.02);
}

TEST(Trapezoid, PlannedAnewOnTheWayItIsNoSlower) {
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    Chance chance(seed);
    const ProfileLimits limits = chance.limits();
    const std::int64_t target = fixed(std::floor(chance.within(100, 1e7)));
    Trapezoid motion;
    motion.move(0, {0, 0}, target, limits);
    const ProfileTicks end = motion.end();
    const auto when = static_cast<ProfileTicks>(chance.of(static_cast<std::uint64_t>(end)));
    const ProfileState from = motion.at(when);
    motion.move(when, from, target, limits);
    SCOPED_TRACE(::testing::Message() << "seed " << seed << " at " << when << " of " << end);
    expect_within(motion, when, from, limits);
    if (HasFatalFailure()) return;
    ASSERT_EQ(motion.at(motion.end()).position, target);
    // Rarely it comes in braking to within a count of it early, and creeps for a millisecond.
    ASSERT_LE(motion.end(), end + end / 15 + 32'000);
    for (int k = 0; k <= 64; ++k)
      ASSERT_LE(motion.at(when + (motion.end() - when) * k / 64).position, target);
  }
}

/// A speed as high as it can be with ramps that are longer than any way: 64 bits do not hold them.
TEST(Trapezoid, ASpeedThatIsNeverReachedDoesNotMatter) {
  for (const std::uint32_t slow : {1000u, 3000u, 15'780u, 100'000u})
    for (const std::uint32_t fast : {10'000'000u, 8'187'473u, kMaxCountsPerSecond, 0xFFFF'FFFFu})
      for (const std::uint32_t other : {slow, 1'556'791u, 0xFFFF'FFFFu})
        for (const long double way : {100.0L, 490'000.0L, 1e7L})
          for (const bool brakes : {false, true}) {
            const ProfileLimits limits{fast, brakes ? other : slow, brakes ? slow : other};
            Trapezoid motion;
            motion.move(0, {0, 0}, fixed(way), limits);
            const long double takes = static_cast<long double>(motion.end()) / kTicks;
            EXPECT_LE(takes, 1.066L * least_time({way, 0, limits, true}) + 200e-6L)
                << way << ": " << limits.velocity << " " << limits.acceleration << " " << limits.deceleration;
          }
}

TEST(Trapezoid, AStopIsTheShortestThatEndsOnAWholeCount) {
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    Chance chance(seed);
    const auto deceleration = static_cast<std::uint32_t>(chance.within(1000, 4e9));
    const long double v = chance.of(8) == 0 ? 0 : chance.within(0.01, 1e6);
    if (v * v / 2 / deceleration > 0x1p29L) continue;
    const int sign = chance.of(2) == 0 ? 1 : -1;
    const ProfileState from{sign * fixed(chance.within(1e-6, 1e6)), sign * velocity_of(v)};
    const auto start = static_cast<ProfileTicks>(chance.of(1'000'000));
    Trapezoid motion;
    motion.stop(start, from, deceleration);
    SCOPED_TRACE(::testing::Message() << "seed " << seed << " from " << v << " by " << deceleration);
    const auto speed = static_cast<std::uint32_t>(std::max<long double>(v + 1.5L, Trapezoid::kCreepSpeed));
    expect_within(motion, start, from, {speed, deceleration, deceleration});
    if (HasFatalFailure()) return;
    const ProfileState end = motion.at(motion.end());
    ASSERT_EQ(end.velocity, 0);
    ASSERT_EQ(end.position % kOneCount, 0);
    const long double way = std::ldexp(static_cast<long double>(end.position - from.position), -32) * sign;
    if (v == 0) {
      ASSERT_LE(std::abs(way), 0.5L);
    } else {
      ASSERT_GE(way, v * v / 2 / deceleration * (1 - 1e-6L) - 1e-6L);
      // The ramp's last tick, and a count.
      ASSERT_LE(way, v * v / 2 / deceleration * (1 + 1e-6L) + v / kTicks + 1.000001L);
    }
    const ProfileLimits limits{speed, deceleration, deceleration};
    const long double least = least_time({std::abs(way), v, limits, true});
    ASSERT_LE(static_cast<long double>(motion.end() - start) / kTicks, 1.066L * least + 5e-3L);
  }
}

TEST(Trapezoid, AfterAShiftAllOfItIsElsewhere) {
  Trapezoid motion, moved;
  const ProfileLimits limits{100'000, 1'000'000, 500'000};
  for (Trapezoid* m : {&motion, &moved}) m->move(100, {0, velocity_of(-20'000)}, fixed(50'000), limits);
  moved.shift(fixed(-1234.5L));
  for (ProfileTicks t = 0; t <= motion.end() + 1000; t += motion.end() / 100) {
    EXPECT_EQ(moved.at(t).position, motion.at(t).position - fixed(1234.5L));
    EXPECT_EQ(moved.at(t).velocity, motion.at(t).velocity);
  }
  EXPECT_EQ(moved.target(), fixed(50'000 - 1234.5L));
  Trapezoid still;
  still.hold(77);
  EXPECT_TRUE(still.done(std::numeric_limits<ProfileTicks>::min()));
  EXPECT_EQ(still.at(0).position, 77);
  EXPECT_FALSE(still.cruises(0));
}

}  // namespace
}  // namespace kinebus::testing_times
