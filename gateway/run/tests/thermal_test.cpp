#include "gateway/run/thermal.hpp"

#include <gtest/gtest.h>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

double after(SimulatedThermal& thermal, BusTime begin, BusTime duration, BusTime step) {
  for (BusTime t = begin; t <= begin + duration; t += step) thermal.on_time(t);
  return thermal.heater(Heater::kHotend).actual_celsius;
}

TEST(Thermal, SettlesOnTheTarget) {
  SimulatedThermal thermal;
  thermal.on_time(BusTime{0});
  thermal.set_target(Heater::kHotend, 210);
  EXPECT_NEAR(after(thermal, BusTime{0}, 600s, 100ms), 210, 0.1);
}

TEST(Thermal, CoolsTowardsTheRoomAndNotBelow) {
  SimulatedThermal thermal;
  thermal.set_target(Heater::kHotend, 210);
  after(thermal, BusTime{0}, 600s, 1s);
  thermal.set_target(Heater::kHotend, 0);
  EXPECT_LT(after(thermal, 600s, 100s, 1s), 120);
  EXPECT_NEAR(after(thermal, 700s, 3600s, 1s), 22, 0.01);
}

TEST(Thermal, LongStepsGiveTheSameAsShortOnes) {
  SimulatedThermal coarse, fine;
  for (SimulatedThermal* thermal : {&coarse, &fine}) {
    thermal->on_time(BusTime{0});
    thermal->set_target(Heater::kHotend, 200);
  }
  EXPECT_NEAR(after(coarse, BusTime{0}, 30s, 10s), after(fine, BusTime{0}, 30s, 10ms), 0.5);
}

TEST(Thermal, WaitIsOverWithinTheWindow) {
  SimulatedThermal thermal;
  thermal.on_time(BusTime{0});
  thermal.set_target(Heater::kHotend, 100);
  const TemperatureWait wait{Heater::kHotend, 100, 2, false};
  EXPECT_FALSE(wait.over(thermal));
  after(thermal, BusTime{0}, 300s, 1s);
  EXPECT_TRUE(wait.over(thermal));
  const TemperatureWait cooling{Heater::kHotend, 50, 2, true};
  EXPECT_FALSE(cooling.over(thermal));
  EXPECT_TRUE((TemperatureWait{Heater::kHotend, 50, 2, false}.over(thermal)));
}

}  // namespace
}  // namespace kinebus
