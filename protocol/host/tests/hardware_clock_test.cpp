// An adapter's time stamps by this computer's clock.
#include "protocol/host/hardware_clock.hpp"

#include <gtest/gtest.h>

#include <random>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

// Frames each 5 ms for a minute, with a crystal that is `ppm` fast, and 0.2 to 8 ms on their way. How far the
// times are from true ones and a constant, after the first second.
struct Spread {
  LocalTime least = LocalTime::max(), most = LocalTime::min();
};
Spread spread_of(double ppm, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> way_us(200, 8000);
  HardwareClock clock;
  Spread spread;
  for (LocalTime true_time = 100s; true_time < 160s; true_time += 5ms) {
    const double adapters_ns = 1e9 + static_cast<double>((true_time - 100s).count()) * (1 + ppm * 1e-6);
    const LocalTime received = true_time + std::chrono::microseconds{way_us(random)};
    const LocalTime got = clock.at(LocalTime{static_cast<std::int64_t>(adapters_ns) / 1000 * 1000}, received);
    EXPECT_LE(got, received);
    if (true_time < 101s) continue;
    spread.least = std::min(spread.least, got - true_time);
    spread.most = std::max(spread.most, got - true_time);
  }
  return spread;
}

TEST(HardwareClock, WhatTheWayTakesIsNoPartOfTheTime) {
  for (const double ppm : {-200.0, -30.0, 0.0, 30.0, 200.0}) {
    const Spread spread = spread_of(ppm, 1);
    EXPECT_LT(spread.most - spread.least, 700us) << ppm << " ppm; the receive times are 7.8 ms apart";
    EXPECT_GE(spread.least, 0us) << ppm;
  }
}

TEST(HardwareClock, OneThatIsSetAnewIsFollowedAtOnce) {
  HardwareClock clock;
  EXPECT_EQ(clock.at(1s, 100s), 100s);
  EXPECT_LE(clock.at(2s, 101s + 3ms), 101s + 301us) << "the way may seem to grow by 300 ppm";
  EXPECT_EQ(clock.at(500ms, 102s), 102s) << "set back";
  EXPECT_EQ(clock.at(1s, 102s + 500ms), 102s + 500ms);
  EXPECT_EQ(clock.at(9s, 103s), 103s) << "set ahead";
}

TEST(HardwareClock, OneFrameThatWasLateIsForgottenWithTheNext) {
  HardwareClock clock;
  EXPECT_EQ(clock.at(1s, 100s), 100s);
  EXPECT_EQ(clock.at(1s + 10ms, 100s + 300ms), 100s + 300ms);
  EXPECT_EQ(clock.at(1s + 20ms, 100s + 20ms), 100s + 20ms);
}

}  // namespace
}  // namespace kinebus
