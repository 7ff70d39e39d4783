// What is noticed as a stall, by given times.

#include "gateway/io/stall_watch.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <thread>

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

std::string why_of_a_stall() {
  StallWatch watch;
  watch.wakes(10s);
  watch.sleeps(10s, 11s);
  return std::string(watch.wakes(12s)->why);
}

TEST(StallWatch, AMissingPriorityIsToldWhereItIsMissing) {
  const std::string told = "no real-time priority";
  std::thread([&] {
    sched_param parameters{};
    ASSERT_EQ(::sched_setscheduler(0, SCHED_OTHER, &parameters), 0);
    EXPECT_NE(why_of_a_stall().find(told), std::string::npos);
    // As the daemon asks for it (become_realtime).
    parameters.sched_priority = 1;
    if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) == 0) {
      EXPECT_EQ(why_of_a_stall().find(told), std::string::npos);
    }
  }).join();
}

}  // namespace
}  // namespace kinebus
