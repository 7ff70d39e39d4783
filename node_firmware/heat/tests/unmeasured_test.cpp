// Hot ends that were never measured: default PID and plain rules. They come back after a break in seconds,
// not in minutes, and one that holds by most of its power is not taken for loose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>

#include "node_firmware/heat/tests/hot_end_bench.hpp"
#include "node_firmware/heat/tests/random_hot_end.hpp"

namespace kinebus::heat {
namespace {

constexpr std::uint32_t kHotEnds = 50;
constexpr double kTarget = 210, kBroken = 196;  // C

TEST(Unmeasured, HotEndsOfAllKindsAreBackAfterABreak) {
  std::mt19937 random(20);
  double slowest = 0, hottest = 0;
  for (std::uint32_t i = 0; i < kHotEnds; ++i) {
    const PlantParameters p = random_hot_end(random);
    HotEndBench bench(false, i + 1, p);
    bench.settings.nominal_mw = static_cast<std::uint32_t>(p.power_w * 1000);
    bench.heater.configure(bench.settings);
    bench.run(0.2);
    bench.heater.set_target(static_cast<std::int32_t>(kTarget * 1000));
    bench.run(300);
    ASSERT_EQ(bench.heater.fault(), HeaterFault::kNone)
        << "hot end " << i << ", " << p.power_w << " W, from cold";
    bench.heater.set_target(0);
    while (bench.plant.block() > kBroken) bench.run(0.1);
    bench.heater.clear_fault();
    bench.heater.set_target(static_cast<std::int32_t>(kTarget * 1000));
    double back = 0;
    for (; back < 120 && bench.plant.sensor() < kTarget - 2; back += 0.1) bench.run(0.1);
    EXPECT_LE(back, 60) << "hot end " << i << ", " << p.power_w << " W";
    for (int t = 0; t < 600; ++t) {
      bench.run(0.1);
      hottest = std::max(hottest, bench.plant.block());
    }
    ASSERT_EQ(bench.heater.fault(), HeaterFault::kNone) << "hot end " << i << ", " << p.power_w << " W, back";
    slowest = std::max(slowest, back);
  }
  EXPECT_LE(hottest, kTarget + 8);
  std::printf(
      "50 hot ends, never measured, from %.0f C to within 2 K of %.0f: at most %.1f s, block at most %.1f "
      "C\n",
      kBroken, kTarget, slowest, hottest);
}

// What the rule for heating lets pass next to the target is found when it has left it.
TEST(Unmeasured, AHeaterWhoseWireIsOffIsStillFound) {
  double slowest = 0;
  for (const double at : {120.0, 190.0, kTarget - 1}) {
    std::mt19937 random(20);
    for (std::uint32_t i = 0; i < kHotEnds; ++i) {
      HotEndBench bench(false, i + 1, random_hot_end(random));
      bench.heater.set_target(static_cast<std::int32_t>(kTarget * 1000));
      for (int t = 0; t < 4000 && bench.plant.sensor() < at; ++t) bench.run(0.1);
      bench.plant.mosfet_open = true;
      const LocalTime since = bench.now;
      bench.run(60);
      ASSERT_EQ(bench.heater.fault(), HeaterFault::kHeatMissing) << "hot end " << i << " at " << at << " C";
      slowest = std::max(slowest, seconds(bench.sound_at - since));
    }
  }
  std::printf("50 hot ends, never measured, heater's wire off: found after at most %.1f s\n", slowest);
}

}  // namespace
}  // namespace kinebus::heat
