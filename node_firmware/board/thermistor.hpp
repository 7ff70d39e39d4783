#pragma once
// Celsius for the steps of a thermistor's divider: straight lines between points made at compile time, for
// the control interrupt.

#include <array>
#include <cstdint>

namespace kinebus {

namespace thermistor {
inline constexpr int kLineBits = 6;  // 64 steps a line
inline constexpr int kLines = 4096 >> kLineBits;

constexpr double logarithm(double x) {
  int doublings = 0;
  for (; x > 1.5; x /= 2) ++doublings;
  for (; x < 0.75; x *= 2) --doublings;
  const double z = (x - 1) / (x + 1), square = z * z;
  double term = z, sum = 0;
  for (int n = 1; n < 30; n += 2, term *= square) sum += term / n;
  return 2 * sum + doublings * 0.69314718055994531;
}
}  // namespace thermistor

/// A thermistor of 10 kOhm at 25 C to ground, 10 kOhm to the reference, 12 bits. Error below 0.5 C from 0 to
/// 110 C.
class Thermistor {
 public:
  explicit consteval Thermistor(double beta_kelvin) {
    using namespace thermistor;
    for (std::size_t i = 0; i < table_.size(); ++i) {
      // The ends stand for "open" and "shorted".
      const double share = i == 0 ? 0.002 : i == kLines ? 0.998 : static_cast<double>(i) / kLines;
      const double kelvin = 1 / (1 / 298.15 + logarithm(share / (1 - share)) / beta_kelvin);
      table_[i] = static_cast<float>(kelvin - 273.15);
    }
  }
  float celsius(std::uint32_t steps) const {
    using namespace thermistor;
    const std::uint32_t clipped = steps < 4095 ? steps : 4095;
    const std::size_t line = clipped >> kLineBits;
    const float part = static_cast<float>(clipped & ((1u << kLineBits) - 1)) * (1.0F / (1 << kLineBits));
    return table_[line] + (table_[line + 1] - table_[line]) * part;
  }

 private:
  std::array<float, thermistor::kLines + 1> table_{};
};

}  // namespace kinebus
