#pragma once
// An accelerometer on the tool, as cheap ones are: noise, steps of its converter, gravity, and a bias.

#include <array>
#include <cstdint>
#include <random>

namespace kinebus {

class Accelerometer {
 public:
  using Vector = std::array<double, 3>;  ///< X Y Z, mm/s^2
  struct Truth {
    double noise = 45;      ///< rms of each reading
    double step = 38.3;     ///< 3.9 mg
    double range = 156900;  ///< 16 g: what is beyond reads as this
    Vector bias{120, -310, 9810};
  };
  Accelerometer(const Truth& truth, std::uint64_t seed) : truth_(truth), random_(seed) {}

  Vector read(const Vector& accel_mm_per_s2);

 private:
  Truth truth_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace kinebus
