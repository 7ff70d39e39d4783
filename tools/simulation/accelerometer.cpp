#include "tools/simulation/accelerometer.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {

Accelerometer::Vector Accelerometer::read(const Vector& accel) {
  Vector read{};
  for (std::size_t i = 0; i < read.size(); ++i) {
    const double felt = accel[i] + truth_.bias[i] + truth_.noise * normal_(random_);
    read[i] = truth_.step * std::round(std::clamp(felt, -truth_.range, truth_.range) / truth_.step);
  }
  return read;
}

}  // namespace kinebus
