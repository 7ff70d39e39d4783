// Faults of a hot end, each at its worst moment: when it is found, when power is gone, how hot the block
// gets.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <string>

#include "node_firmware/heat/fan.hpp"
#include "node_firmware/heat/tests/hot_end_bench.hpp"

namespace kinebus::heat {
namespace {

using namespace std::chrono_literals;

constexpr double kLimit = kHotEndLimit;

enum class When { kHeating, kHolding, kOff };
struct FaultCase {
  const char* name;
  When when;
  std::function<void(ThermalPlant&)> breaks;
  HeaterFault expected;
  double found_within_s, power_off_within_s;
};

// found_within_s are claims: an electrical fault 0.5 s, the others less than what peers take.
const std::vector<FaultCase>& cases() {
  static const std::vector<FaultCase> all{
      {"sensor open", When::kHeating, [](auto& p) { p.sensor_open = true; }, HeaterFault::kSensorOpen, 0.3,
       0.05},
      {"sensor open", When::kHolding, [](auto& p) { p.sensor_open = true; }, HeaterFault::kSensorOpen, 0.3,
       0.05},
      {"sensor open", When::kOff, [](auto& p) { p.sensor_open = true; }, HeaterFault::kSensorOpen, 0.3, 0},
      {"sensor shorted", When::kHeating, [](auto& p) { p.sensor_short = true; }, HeaterFault::kSensorShort,
       0.3, 0.05},
      {"sensor shorted", When::kHolding, [](auto& p) { p.sensor_short = true; }, HeaterFault::kSensorShort,
       0.3, 0.05},
      {"bad plug, 200 Ohm", When::kHolding, [](auto& p) { p.series_ohm = 200; }, HeaterFault::kSensorJump,
       0.3, 0.05},
      {"converter silent", When::kHeating, [](auto& p) { p.silent = true; }, HeaterFault::kSensorSilent, 0.3,
       0.05},
      {"converter silent", When::kHolding, [](auto& p) { p.silent = true; }, HeaterFault::kSensorSilent, 0.3,
       0.05},
      {"converter frozen", When::kHeating, [](auto& p) { p.frozen = true; }, HeaterFault::kHeatMissing, 2, 2},
      {"converter frozen", When::kHolding, [](auto& p) { p.frozen = true; }, HeaterFault::kSensorSilent, 5.2,
       5.2},
      {"sensor out of its hole", When::kHeating, [](auto& p) { p.sensor_contact = 0; },
       HeaterFault::kHeatMissing, 1, 1},
      {"sensor out of its hole", When::kHolding, [](auto& p) { p.sensor_contact = 0; },
       HeaterFault::kHeatMissing, 1, 1},
      {"sensor half out", When::kHolding, [](auto& p) { p.sensor_contact = 0.3; }, HeaterFault::kHeatMissing,
       1, 1},
      {"heater out of its hole", When::kHeating, [](auto& p) { p.heater_contact = 0.02; },
       HeaterFault::kHeatMissing, 5, 5},
      {"heater out of its hole", When::kHolding, [](auto& p) { p.heater_contact = 0.02; },
       HeaterFault::kHeatMissing, 9, 9},
      {"heater's wire off", When::kHeating, [](auto& p) { p.mosfet_open = true; }, HeaterFault::kHeatMissing,
       5, 5},
      {"heater's wire off", When::kHolding, [](auto& p) { p.mosfet_open = true; }, HeaterFault::kHeatMissing,
       9, 9},
      {"MOSFET stuck on", When::kHolding, [](auto& p) { p.mosfet_stuck = true; }, HeaterFault::kHeatUnasked,
       5, 5},
      {"MOSFET stuck on", When::kOff, [](auto& p) { p.mosfet_stuck = true; }, HeaterFault::kHeatUnasked, 8,
       0},
  };
  return all;
}

TEST(Safety, EveryFaultTakesThePowerBeforeTheBlockIsTooHot) {
  std::printf("%-24s %-8s %9s %9s %12s\n", "fault", "in", "found, s", "off, s", "hottest, C");
  for (const FaultCase& each : cases()) {
    HotEndBench bench(true);
    const char* when = each.when == When::kHeating   ? "heating"
                       : each.when == When::kHolding ? "holding"
                                                     : "off";
    const std::string name = std::string(each.name) + ", " + when;
    if (each.when != When::kOff) bench.heater.set_target(210'000);
    bench.run(each.when == When::kHolding ? 300 : 0);
    if (each.when == When::kHeating)
      while (bench.plant.sensor() < 150) bench.run(0.01);
    ASSERT_EQ(bench.heater.fault(), HeaterFault::kNone) << name;
    bench.plant.forget_hottest();
    const LocalTime broken = bench.now;
    each.breaks(bench.plant);
    bench.run(120);
    const double found = seconds(bench.sound_at - broken);
    const double off = std::max(0.0, seconds(bench.powered_at - broken));
    std::printf("%-24s %-8s %9.2f %9.2f %12.1f\n", each.name, when, found, off, bench.plant.hottest());
    EXPECT_EQ(bench.heater.fault(), each.expected) << name;
    EXPECT_LE(found, each.found_within_s) << name;
    EXPECT_LE(off, each.power_off_within_s) << name;
    EXPECT_LE(bench.plant.hottest(), kLimit + 5) << name;
    EXPECT_LE(bench.plant.hottest(), 210 + 20) << name;
    EXPECT_EQ(bench.heater.target(), 0) << name;
    // Fault or no fault: without a reason to heat nothing heats again by itself.
    bench.plant.sensor_open = bench.plant.sensor_short = bench.plant.silent = bench.plant.frozen = false;
    bench.plant.series_ohm = 0;
    bench.run(5);
    EXPECT_EQ(bench.heater.output(bench.sensor), 0u) << name;
  }
}

TEST(Safety, AnUnmeasuredHeaterIsWatchedByRules) {
  for (const bool holding : {false, true}) {
    HotEndBench bench(false);
    bench.heater.set_target(210'000);
    bench.run(holding ? 300 : 20);
    ASSERT_EQ(bench.heater.fault(), HeaterFault::kNone);
    const LocalTime broken = bench.now;
    bench.plant.mosfet_open = true;
    bench.run(90);
    EXPECT_EQ(bench.heater.fault(), HeaterFault::kHeatMissing);
    EXPECT_LE(seconds(bench.sound_at - broken), 45);
  }
}

TEST(Safety, ASensorThatIsPutBackIsNoHeatUnasked) {
  for (const bool stuck : {false, true}) {
    HotEndBench bench(true);
    bench.heater.set_target(210'000);
    bench.run(300);
    bench.plant.sensor_contact = 0;
    bench.run(20);
    ASSERT_EQ(bench.heater.fault(), HeaterFault::kHeatMissing);
    bench.plant.mosfet_stuck = stuck;
    bench.plant.sensor_contact = 1;
    bench.run(60);
    if (stuck) {
      EXPECT_EQ(bench.heater.fault(), HeaterFault::kHeatUnasked) << "a second fault is found all the same";
      EXPECT_LE(bench.plant.hottest(), 210 + 30);
      continue;
    }
    EXPECT_EQ(bench.heater.fault(), HeaterFault::kHeatMissing);
    bench.heater.clear_fault();
    bench.heater.set_target(210'000);
    bench.run(100);
    EXPECT_EQ(bench.heater.fault(), HeaterFault::kNone);
    EXPECT_NEAR(bench.plant.sensor(), 210, 0.5);
  }
}

TEST(Safety, NothingIsFoundWhereNothingIsWrong) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    HotEndBench bench(true, seed);
    const auto sound = [&](const char* what) {
      ASSERT_EQ(bench.heater.fault(), HeaterFault::kNone) << what << ", seed " << seed;
    };
    bench.heater.set_target(210'000);
    bench.run(200);
    sound("heating");
    bench.plant.fan = 1;
    bench.run(60);
    sound("fan on");
    bench.plant.flow_mm3_per_s = 24;
    bench.run(120);
    sound("24 mm3/s");
    bench.plant.flow_mm3_per_s = 0;
    bench.run(60);
    bench.plant.fan = 0;
    bench.run(60);
    sound("all off again");
    bench.heater.set_target(260'000);
    bench.run(150);
    sound("up");
    bench.heater.set_target(170'000);
    bench.run(200);
    sound("down");
    bench.heater.set_target(0);
    bench.run(600);
    sound("off");
    bench.heater.set_target(210'000);
    bench.run(100);
    sound("heated again");
    EXPECT_NEAR(bench.plant.sensor(), 210, 0.5);
  }
}

TEST(Safety, TheLimitHoldsWhateverTheTarget) {
  HotEndBench bench(true);
  bench.heater.set_target(400'000);
  bench.run(300);
  EXPECT_EQ(bench.heater.fault(), HeaterFault::kTooHot);
  EXPECT_LE(bench.plant.hottest(), kLimit + 15) << "at full power into the limit";
}

TEST(Safety, ASupplyThatIsNotNominalIsMadeUpFor) {
  for (const std::uint32_t volts : {20u, 24u, 28u}) {
    HotEndBench bench(true);
    bench.plant.p.supply_v = volts;
    double worst = 0;
    bench.heater.set_target(210'000);
    for (int i = 0; i < 30000; ++i) {
      bench.now += SensorInput::kSamplePeriod;
      bench.plant.step(bench.heater.output(bench.sensor) / static_cast<double>(kFullPower));
      bench.sensor.on_sample(bench.now, bench.plant.ratio());
      if (i % 10 == 9) bench.heater.step(bench.sensor, volts * 1000);
      worst = std::max(worst, bench.plant.block() - 210);
    }
    EXPECT_LE(worst, 1.0) << volts << " V";
    EXPECT_NEAR(bench.plant.sensor(), 210, 0.5) << volts << " V";
    EXPECT_EQ(bench.heater.fault(), HeaterFault::kNone) << volts << " V";
  }
}

TEST(Safety, ARelayForMainsSwitchesWholeTicks) {
  HotEndBench bench(true);
  bench.settings.output = OutputKind::kWholeTicks;
  bench.heater.configure(bench.settings);
  bench.heater.set_target(210'000);
  for (int i = 0; i < 3000; ++i) {
    bench.run(0.1);
    const std::uint32_t output = bench.heater.output(bench.sensor);
    ASSERT_TRUE(output == 0 || output == kFullPower);
  }
  EXPECT_NEAR(bench.plant.sensor(), 210, 1);
}

TEST(Fan, StartsWithAKickAndDoesNotCreep) {
  Fan fan;
  fan.configure({.kick_ms = 200, .least_duty = 15});
  LocalTime now{1s};
  fan.set_command(kFullFan / 20);
  fan.step(now, 20'000, false);
  EXPECT_EQ(fan.output(), kFullFan);
  fan.step(now += 200ms, 20'000, false);
  EXPECT_EQ(fan.output(), kFullFan * 15 / 100);
  fan.set_command(0);
  fan.step(now += 100ms, 20'000, false);
  EXPECT_EQ(fan.output(), 0);
  fan.set_command(-5);
  fan.step(now += 100ms, 20'000, false);
  EXPECT_EQ(fan.output(), 0);
}

TEST(Fan, OfAHotEndRunsFromFiftyDegreesAndAtAFault) {
  Fan fan;
  fan.configure({.function = FanFunction::kHotEnd, .heater = 1});
  LocalTime now{1s};
  const auto output = [&](std::int32_t mc, bool fault) {
    fan.step(now += kControlTick, mc, fault);
    return fan.output();
  };
  EXPECT_EQ(output(49'000, false), 0);
  EXPECT_EQ(output(50'000, false), kFullFan);
  EXPECT_EQ(output(46'000, false), kFullFan) << "not off and on at the threshold";
  EXPECT_EQ(output(44'000, false), 0);
  EXPECT_EQ(output(20'000, true), kFullFan) << "what is not measured may be hot";
}

TEST(Fan, ThatStandsIsFoundByItsTacho) {
  Fan fan;
  fan.configure({.pulses_per_turn = 2});
  LocalTime now{1s};
  fan.set_command(kFullFan);
  for (int i = 0; i < 50; ++i) {
    fan.on_pulses(20);
    fan.step(now += kControlTick, 20'000, false);
  }
  EXPECT_FALSE(fan.stalled());
  EXPECT_EQ(fan.turns_per_minute(), 6000);
  for (int i = 0; i < 19; ++i) fan.step(now += kControlTick, 20'000, false);
  EXPECT_FALSE(fan.stalled());
  fan.step(now += kControlTick, 20'000, false);
  EXPECT_TRUE(fan.stalled()) << "2 s";
  fan.on_pulses(3);
  fan.step(now += kControlTick, 20'000, false);
  EXPECT_FALSE(fan.stalled());
}

}  // namespace
}  // namespace kinebus::heat
