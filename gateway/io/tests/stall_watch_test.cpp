// What is noticed as a stall, by given times.

#include "gateway/io/stall_watch.hpp"

#include <gtest/gtest.h>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

TEST(StallWatch, WantedSleepIsNone) {
  StallWatch watch;
  EXPECT_FALSE(watch.wakes(10s));
  watch.sleeps(10s + 1ms, 13s);
  EXPECT_FALSE(watch.wakes(13s + 20ms));
}

TEST(StallWatch, WhatIsLostInTheTurnAndAfterTheDeadlineCounts) {
  StallWatch watch;
  EXPECT_FALSE(watch.wakes(10s));
  watch.sleeps(10s + 80ms, 11s);
  const auto stall = watch.wakes(11s + 700ms);
  ASSERT_TRUE(stall);
  EXPECT_EQ(stall->length, LocalTime{780ms});
  EXPECT_FALSE(std::string(stall->why).empty());
  watch.sleeps(12s, LocalTime{0});
  EXPECT_TRUE(watch.wakes(12s + 150ms)) << "it wanted to go on at once";
}

}  // namespace
}  // namespace kinebus
