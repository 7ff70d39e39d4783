#pragma once
// Hot ends of all kinds: 24 to 80 W, capacities +-50 %, dead times of 1 to 6 s.

#include <random>

#include "node_firmware/port/host/thermal_plant.hpp"

namespace kinebus::heat {

inline PlantParameters random_hot_end(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  PlantParameters p;
  p.power_w = between(24, 80);
  const double capacity = 16.7 * between(0.5, 1.5);
  p.heater_j_per_k = 0.12 * capacity;
  p.block_j_per_k = 0.88 * capacity;
  p.heater_w_per_k = between(2.5, 5);
  p.loss_w_per_k = between(0.04, 0.08);
  p.ambient_c = between(18, 32);
  p.dead_s = between(1, 6);
  p.sensor_lag_s = between(0.5, 2.5);
  return p;
}

}  // namespace kinebus::heat
