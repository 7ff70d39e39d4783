#pragma once
// A hot end or bed as it is, in double precision: heater, block and sensor as three lumps, a dead
// time, loss by convection and radiation, filament and fan, a converter of 12 bits with noise, and everything
// that can break. It is another model than that of the controller, with more in it, and its numbers are its
// own.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <random>

#include "node_firmware/heat/thermometry.hpp"
#include "node_firmware/port/host/sensor_part.hpp"

namespace kinebus::heat {

struct PlantParameters {
  double power_w = 40;  // at the nominal supply
  double supply_v = 24, nominal_v = 24;
  double heater_j_per_k = 2.5;  // the cartridge
  double heater_w_per_k = 4;    // cartridge to block
  double block_j_per_k = 14;
  double loss_w_per_k = 0.06;  // to the air
  double radiation_w_per_k4 = 3e-11;
  double fan_w_per_k = 0.03;  // more, with the fan full on
  double sensor_lag_s = 1.5;
  double dead_s = 1.2;  // transport: the sensor feels the block of that long ago
  double filament_j_per_mm3k = 0.0023;
  double noise_k = 0.05;  // rms of one sample, before the converter's steps
  double ambient_c = 22;
};

class ThermalPlant {
 public:
  static constexpr double kStep = 0.01;        // s; a sample
  static constexpr double kHeaterLoss = 0.01;  // W/K, of the cartridge itself

  // What can break, at any time.
  bool sensor_open = false, sensor_short = false;
  double sensor_contact = 1;  // of the sensor with the block: 0 hangs in air
  double heater_contact = 1;  // of the cartridge with the block
  double series_ohm = 0;      // a bad plug
  bool mosfet_stuck = false;
  bool mosfet_open = false;
  bool silent = false;  // the converter says nothing
  bool frozen = false;  // the converter repeats itself
  bool contactor = true;
  double fan = 0, flow_mm3_per_s = 0;
  /// What is plugged in; as it comes a thermistor of 100 kOhm, beta 3950, on 4.7 kOhm.
  SensorPart part{};

  explicit ThermalPlant(const PlantParameters& parameters, std::uint32_t seed = 1)
      : p(parameters), random_(seed) {
    begin_at(p.ambient_c);
  }
  /// Warm all through, as after a print a moment ago.
  void begin_at(double celsius) {
    heater_ = block_ = sensor_ = celsius;
    past_.assign(static_cast<std::size_t>(p.dead_s / kStep) + 1, celsius);
  }

  /// One sample's time with that share of power commanded.
  void step(double duty) {
    const double on = !contactor || mosfet_open ? 0 : mosfet_stuck ? 1 : duty;
    const double supply = p.supply_v / p.nominal_v;
    const double given = on * p.power_w * supply * supply;
    const double across = (heater_ - block_) * p.heater_w_per_k * heater_contact;
    const double own_loss = (heater_ - p.ambient_c) * kHeaterLoss;
    heater_ += (given - across - own_loss) / p.heater_j_per_k * kStep;
    const double above = block_ - p.ambient_c, kelvin = block_ + 273.15, room = p.ambient_c + 273.15;
    const double lost =
        above * (p.loss_w_per_k + fan * p.fan_w_per_k + flow_mm3_per_s * p.filament_j_per_mm3k) +
        p.radiation_w_per_k4 * (kelvin * kelvin * kelvin * kelvin - room * room * room * room);
    block_ += (across - lost) / p.block_j_per_k * kStep;
    past_.push_back(block_);
    const double felt = past_.front();
    past_.pop_front();
    // Out of its hole it cools in the air, four times slower.
    sensor_ += (sensor_contact * (felt - sensor_) + (1 - sensor_contact) * 0.25 * (p.ambient_c - sensor_)) /
               p.sensor_lag_s * kStep;
    hottest_ = std::max(hottest_, block_);
  }

  /// The converter's word for its sensor: 16 conversions of 12 bits.
  std::uint32_t ratio() {
    if (frozen) return last_ratio_;
    const double divided = divider();
    double sum = 0;
    for (int i = 0; i < 16; ++i) {
      const double steps = divided * 4095 + normal_(random_) * kNoiseSteps;
      sum += std::clamp(std::round(steps), 0.0, 4095.0);
    }
    return last_ratio_ = static_cast<std::uint32_t>(std::lround(sum / 16 / 4095 * kFullRatio));
  }

  /// What a converter outside is given, as a share of its reference: with noise, not yet in steps.
  double voltage() { return divider() + normal_(random_) * kNoiseSteps / 4095; }

  /// What the sensor and its leads have, with noise.
  double ohm() {
    if (sensor_open) return 1e9;
    if (sensor_short) return 0.1;
    return part.ohm(sensor_ + p.noise_k * normal_(random_)) + series_ohm;
  }

  double block() const { return block_; }
  double sensor() const { return sensor_; }
  double heater() const { return heater_; }
  double hottest() const { return hottest_; }
  void forget_hottest() { hottest_ = block_; }

  PlantParameters p;

 private:
  static constexpr double kNoiseSteps = 0.6;

  double divider() { return part.share(ohm()); }

  double heater_ = 0, block_ = 0, sensor_ = 0, hottest_ = 0;
  std::deque<double> past_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_{0, 1};
  std::uint32_t last_ratio_ = 0;
};

}  // namespace kinebus::heat
