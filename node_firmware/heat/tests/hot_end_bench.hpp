#pragma once
// A heater with its sensor on a plant of its own, sample by sample, without a node around them.

#include <gtest/gtest.h>

#include <optional>

#include "node_firmware/heat/heater.hpp"
#include "node_firmware/port/host/thermal_plant.hpp"

namespace kinebus::heat {

inline constexpr double kHotEndLimit = 280;  // C

class HotEndBench {
 public:
  explicit HotEndBench(bool measured, std::uint32_t seed = 1, const PlantParameters& parameters = {})
      : plant(parameters, seed) {
    EXPECT_EQ(sensor.configure({.kind = SensorKind::kCustomBeta, .low_mc = -5'000}, now), SetupError::kNone);
    settings.watch.limit_mc = static_cast<std::int32_t>(kHotEndLimit * 1000);
    heater.configure(settings);
    run(0.2);
    if (!measured) return;
    HeatTuning tuning;
    heater.begin_tuning(tuning, sensor, 210'000);
    while (heater.tuning()) run(0.1);
    EXPECT_EQ(tuning.state(), HeatTuning::State::kDone);
    settings.model = tuning.result();
    settings.pid = pid_for(tuning.result());
    heater.configure(settings);
    run(0.1);
  }
  void run(double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += ThermalPlant::kStep) sample();
  }
  void sample() {
    now += SensorInput::kSamplePeriod;
    plant.step(heater.output(sensor) / static_cast<double>(kFullPower));
    if (!plant.silent) sensor.on_sample(now, plant.ratio());
    sensor.on_time(now);
    if (++samples_ % 10 == 0) {
      if (told_w) heater.set_feed_forward(static_cast<std::int32_t>(1000 * *told_w), plant.fan == fan_);
      fan_ = plant.fan;
      heater.step(sensor, 24'000);
    }
    // As the node does: this fault opens the contactor.
    if (heater.fault() == HeaterFault::kHeatUnasked) plant.contactor = false;
    if (heater.output(sensor) != 0) powered_at = now;
    if (heater.fault() == HeaterFault::kNone) sound_at = now;
  }

  ThermalPlant plant;
  SensorInput sensor;
  HeaterSettings settings;
  Heater heater;
  /// What the filament takes, by a master that tells always, on a node that knows its fans: W; none: neither.
  std::optional<double> told_w;
  LocalTime now{std::chrono::seconds{1}}, powered_at{0}, sound_at{0};

 private:
  int samples_ = 0;
  double fan_ = 0;
};

inline double seconds(LocalTime t) {
  return static_cast<double>(t.count()) * 1e-9;
}

}  // namespace kinebus::heat
