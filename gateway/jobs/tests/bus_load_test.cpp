#include "gateway/jobs/bus_load.hpp"

#include <gtest/gtest.h>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

TEST(BusLoad, SteadyTrafficHasEqualMeanAndPeak) {
  BusLoad load;
  for (int ms = 0; ms < 10'000; ++ms) load.add(BusTime{std::chrono::milliseconds{ms}}, 100);
  EXPECT_NEAR(load.mean(), 0.1, 1e-3);
  EXPECT_NEAR(load.peak_second(), 0.1, 1e-3);
  EXPECT_NEAR(load.last_second(), 0.1, 1e-3);
}

TEST(BusLoad, BusiestSecondIsFoundBetweenWholeSeconds) {
  BusLoad load;
  load.add(0s, 0);
  for (int ms = 500; ms < 1500; ++ms) load.add(BusTime{std::chrono::milliseconds{ms}}, 400);
  load.advance(10s);
  EXPECT_NEAR(load.peak_second(), 0.4, 1e-3);
  EXPECT_EQ(load.last_second(), 0);
  EXPECT_NEAR(load.mean(), 0.04, 1e-3);
}

TEST(BusLoad, LongSilenceCostsNoTimeAndForgets) {
  BusLoad load;
  load.add(1s, 1000);
  load.advance(std::chrono::hours{10'000});
  EXPECT_EQ(load.last_second(), 0);
  EXPECT_EQ(load.total_bits(), 1000);
}

}  // namespace
}  // namespace kinebus
