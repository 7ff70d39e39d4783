// The model's watch over 50 random hot ends: what is loose is found, and what is only fan, filament, draught
// or a new target is not taken for it.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "node_firmware/heat/tests/hot_end_bench.hpp"
#include "node_firmware/heat/tests/random_hot_end.hpp"

namespace kinebus::heat {
namespace {

constexpr std::uint32_t kHotEnds = 50;

TEST(Watch, AllKindsOfHotEndsAreWatchedAndNotAccused) {
  double slowest = 0, slowest_beyond = 0;
  std::mt19937 random(20);
  for (std::uint32_t i = 0; i < kHotEnds; ++i) {
    const PlantParameters p = random_hot_end(random);
    for (const bool broken : {false, true}) {
      HotEndBench bench(true, i + 1, p);
      ASSERT_TRUE(bench.settings.model.usable()) << "hot end " << i;
      bench.heater.set_target(210'000);
      while (bench.plant.sensor() < 150) bench.run(0.1);
      ASSERT_EQ(bench.heater.fault(), HeaterFault::kNone) << "hot end " << i << " heating";
      if (broken) {
        bench.plant.heater_contact = 0.02;
        const LocalTime at = bench.now;
        bench.run(60);
        EXPECT_EQ(bench.heater.fault(), HeaterFault::kHeatMissing) << "hot end " << i;
        const double found = seconds(bench.sound_at - at);
        slowest = std::max(slowest, found);
        slowest_beyond = std::max(slowest_beyond, found - p.dead_s - p.sensor_lag_s);
        continue;
      }
      // Fan and filament take a third of the power together, at once, while it heats and while it holds.
      const double flow =
          std::max(0.0, (p.power_w / 3 - 190 * p.fan_w_per_k) / (190 * p.filament_j_per_mm3k));
      for (int times = 0; times < 3; ++times) {
        bench.plant.fan = 1;
        bench.plant.flow_mm3_per_s = flow;
        bench.run(times == 0 ? 15 : 60);
        ASSERT_EQ(bench.heater.fault(), HeaterFault::kNone) << "hot end " << i << " with flow " << flow;
        bench.plant.fan = bench.plant.flow_mm3_per_s = 0;
        bench.run(60);
        ASSERT_EQ(bench.heater.fault(), HeaterFault::kNone) << "hot end " << i << " without";
      }
      bench.heater.set_target(240'000);
      bench.run(60);
      bench.heater.set_target(150'000);
      bench.run(120);
      bench.heater.set_target(0);
      bench.run(300);
      bench.heater.set_target(210'000);
      bench.run(60);
      ASSERT_EQ(bench.heater.fault(), HeaterFault::kNone) << "hot end " << i << " up and down";
    }
  }
  std::printf(
      "50 hot ends, heater loose while heating: found after at most %.1f s, %.1f s beyond dead time and "
      "lag\n",
      slowest, slowest_beyond);
  EXPECT_LE(slowest_beyond, 3);
}

// Behind a master that tells what filament takes, as the gateway does.
TEST(Watch, InHoldingALooseHeaterIsFoundADeadTimeLater) {
  struct Broken {
    const char* name;
    void (*breaks)(ThermalPlant&);
    HeaterFault expected;
    double most_s;  // beyond dead time and lag
  };
  const Broken all[] = {
      {"heater out of its hole", [](ThermalPlant& p) { p.heater_contact = 0.02; }, HeaterFault::kHeatMissing,
       1.5},
      {"heater's wire off", [](ThermalPlant& p) { p.mosfet_open = true; }, HeaterFault::kHeatMissing, 2.5},
      {"sensor out of its hole", [](ThermalPlant& p) { p.sensor_contact = 0; }, HeaterFault::kHeatMissing, 0},
      {"MOSFET stuck on", [](ThermalPlant& p) { p.mosfet_stuck = true; }, HeaterFault::kHeatUnasked, 9},
  };
  std::printf("%-24s %8s %8s %28s %10s\n", "50 hot ends, holding", "mean, s", "worst, s",
              "beyond dead time and lag, s", "hottest, C");
  for (const Broken& each : all) {
    double sum = 0, worst = 0, beyond = -100, hottest = 0;
    std::mt19937 random(20);
    for (std::uint32_t i = 0; i < kHotEnds; ++i) {
      const PlantParameters p = random_hot_end(random);
      HotEndBench bench(true, i + 1, p);
      bench.told_w = 0;
      bench.heater.set_target(210'000);
      bench.run(200);
      ASSERT_EQ(bench.heater.fault(), HeaterFault::kNone) << "hot end " << i;
      bench.plant.forget_hottest();
      each.breaks(bench.plant);
      const LocalTime at = bench.now;
      bench.run(60);
      EXPECT_EQ(bench.heater.fault(), each.expected) << each.name << ", hot end " << i;
      const double found = seconds(bench.sound_at - at);
      EXPECT_LE(found - p.dead_s - p.sensor_lag_s, each.most_s) << each.name << ", hot end " << i;
      EXPECT_LE(seconds(bench.powered_at - at), found + 0.01) << each.name << ", hot end " << i;
      sum += found;
      worst = std::max(worst, found);
      beyond = std::max(beyond, found - p.dead_s - p.sensor_lag_s);
      hottest = std::max(hottest, bench.plant.hottest());
    }
    std::printf("%-24s %8.1f %8.1f %28.1f %10.1f\n", each.name, sum / kHotEnds, worst, beyond, hottest);
  }
}

// What filament takes is told 30 % wrong either way; the fan and a draught that takes as much are not told.
TEST(Watch, NothingIsAccusedOfWhatFanFlowAndDraughtTake) {
  std::mt19937 random(31);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (std::uint32_t i = 0; i < kHotEnds; ++i) {
    const PlantParameters p = random_hot_end(random);
    HotEndBench bench(true, i + 1, p);
    bench.told_w = 0;
    const double wrong = between(0.7, 1.3);
    const auto flows = [&](double mm3_per_s) {
      const double w = mm3_per_s * p.filament_j_per_mm3k * 190;
      bench.told_w = w * wrong;
      bench.run(0.5);  // as far ahead as the node heats
      bench.plant.flow_mm3_per_s = mm3_per_s;
    };
    // No more than the heater can hold up.
    const double most_flow =
        std::min(24.0, (p.power_w * 0.8 - 190 * (p.loss_w_per_k + p.fan_w_per_k + 0.02)) /
                           (190 * p.filament_j_per_mm3k));
    bench.heater.set_target(210'000);
    bench.run(between(20, 200));
    for (int times = 0; times < 40; ++times) {
      switch (std::uniform_int_distribution<int>(0, 6)(random)) {
        case 0:
          bench.plant.fan = between(0, 1) < 0.5 ? 0 : 1;
          break;
        case 1:
          flows(std::max(0.0, between(0, most_flow)));
          break;
        case 2:
          flows(0);
          bench.plant.fan = 1;
          break;
        case 3:
          bench.plant.p.loss_w_per_k = p.loss_w_per_k + between(0, 0.5 * p.fan_w_per_k);
          break;
        case 4:
          bench.plant.p.ambient_c = p.ambient_c + between(-5, 15);  // a bed below it
          break;
        case 5:
          bench.heater.set_target(between(0, 1) < 0.2 ? 0 : static_cast<std::int32_t>(between(150e3, 260e3)));
          break;
        default:
          bench.plant.fan = between(0, 1);
          flows(std::max(0.0, between(0, most_flow)));
      }
      bench.run(between(1, 40));
      EXPECT_EQ(bench.heater.fault(), HeaterFault::kNone)
          << "hot end " << i << ": " << p.power_w << " W, " << p.block_j_per_k + p.heater_j_per_k
          << " J/K, dead " << p.dead_s << ", lag " << p.sensor_lag_s << "; step " << times << ", fan "
          << bench.plant.fan << ", flow " << bench.plant.flow_mm3_per_s;
      if (bench.heater.fault() != HeaterFault::kNone) break;
    }
  }
}

}  // namespace
}  // namespace kinebus::heat
