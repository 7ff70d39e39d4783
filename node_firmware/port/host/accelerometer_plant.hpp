#pragma once
// An ADXL345 as its data sheet has it: 3200 readings a second by a clock of its own, 3.9 mg a count to 16 g,
// noise, an offset, and a queue of 32 readings that a master empties in time or loses the oldest of.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "node_firmware/heat/vibration_meter.hpp"

namespace kinebus::heat {

class AccelerometerPlant {
 public:
  using Vector = std::array<double, 3>;                                 ///< X Y Z, mm/s^2
  static constexpr double kRate = 3200, kCount = 38.246, kNoise = 1.1;  // Hz, mm/s^2, counts
  static constexpr std::int16_t kRange = 4095;
  static constexpr std::size_t kQueue = 32;

  /// Its rate is off by that, as a part.
  explicit AccelerometerPlant(std::uint32_t seed = 1, double rate_error = 0.011)
      : rate_(kRate * (1 + rate_error)), random_(seed) {}

  bool silent = false;
  /// What the tool feels besides gravity, at a time since the start, s.
  std::function<Vector(double)> feels = [](double) { return Vector{}; };

  /// So much time goes by.
  void step(double seconds) {
    end_ += seconds;
    for (; next_ <= end_; next_ += 1 / rate_) {
      const Vector accel = feels(next_);
      const std::size_t drawn = random_();
      VibrationMeter::Reading reading{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double counts =
            (accel[axis] + kOffset[axis]) / kCount + kNoise * noise()[(drawn >> (10 * axis)) % kNoises];
        reading[axis] = static_cast<std::int16_t>(
            std::clamp(std::lround(counts), -std::lround(kRange), std::lround(kRange)));
      }
      queue_.push_back(reading);
      if (queue_.size() > kQueue) queue_.erase(queue_.begin());
    }
  }
  /// What has been measured since the last call.
  std::vector<VibrationMeter::Reading> take() {
    if (silent) queue_.clear();
    return std::exchange(queue_, {});
  }
  double rate() const { return rate_; }

 private:
  static constexpr Vector kOffset{120, -310, 9810};

  static constexpr std::size_t kNoises = 1024;
  /// Of standard deviation 1, to draw from: three normal numbers a reading were a tenth of a simulated print.
  static const std::array<float, kNoises>& noise() {
    static const auto drawn = [] {
      std::array<float, kNoises> all{};
      std::mt19937 random;
      std::normal_distribution<float> normal;
      for (float& one : all) one = normal(random);
      return all;
    }();
    return drawn;
  }

  double rate_, end_ = 0, next_ = 0;
  std::vector<VibrationMeter::Reading> queue_;
  std::minstd_rand random_;
};

}  // namespace kinebus::heat
