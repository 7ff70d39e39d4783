#pragma once
// Sine and cosine of an electrical angle, as the control interrupt needs them: a table and a straight line.

#include <array>
#include <cstdint>

namespace kinebus::motor {

/// A full electrical turn (four full steps, 1024 counts) is 2^32.
using Angle = std::uint32_t;
inline constexpr std::int32_t kAnglePerCount = 1 << 22;

struct SineCosine {
  float sine = 0, cosine = 1;
};

namespace sine_table {
inline constexpr int kBits = 10;
inline constexpr std::size_t kTurn = std::size_t{1} << kBits;

constexpr double sine_of(double x) {  // |x| <= pi/4
  double term = x, sum = x;
  for (int n = 1; n < 9; ++n) {
    term *= -x * x / ((2 * n) * (2 * n + 1));
    sum += term;
  }
  return sum;
}
constexpr double cosine_of(double x) {
  double term = 1, sum = 1;
  for (int n = 1; n < 9; ++n) {
    term *= -x * x / ((2 * n - 1) * (2 * n));
    sum += term;
  }
  return sum;
}
/// One and a quarter turns, so that the cosine needs no wrapping, and one more to end the last line.
inline constexpr auto kTable = [] {
  std::array<float, kTurn + kTurn / 4 + 1> table{};
  constexpr double kPi = 3.14159265358979323846;
  for (std::size_t i = 0; i < table.size(); ++i) {
    // To the nearest quarter, so that the series is short.
    const std::size_t quarter = (i + kTurn / 8) / (kTurn / 4);
    const std::size_t nearest = quarter * (kTurn / 4);
    const double x = (static_cast<double>(i) - static_cast<double>(nearest)) * 2 * kPi / kTurn;
    const double value = (quarter % 2) == 0 ? sine_of(x) : cosine_of(x);
    table[i] = static_cast<float>((quarter % 4) < 2 ? value : -value);
  }
  return table;
}();
}  // namespace sine_table

/// Error at most 5e-6.
inline SineCosine sine_cosine(Angle angle) {
  using namespace sine_table;
  const std::size_t i = angle >> (32 - kBits);
  const float part = static_cast<float>(angle << kBits >> 8) * 0x1p-24F;
  const float* const s = &kTable[i];
  const float* const c = s + kTurn / 4;
  return {s[0] + (s[1] - s[0]) * part, c[0] + (c[1] - c[0]) * part};
}

/// Of a motor position in counts with 32 fractional bits: 256 counts a full step.
constexpr Angle angle_of(std::int64_t position) {
  return static_cast<Angle>(static_cast<std::uint64_t>(position) >> 10);
}
/// rad/s for a velocity in counts/s.
inline constexpr float kRadiansPerCount = 6.2831853F / 1024.0F;

/// An angle from radians; |radians| < 2^7 turns.
inline Angle angle_from(float radians) {
  const float turns_q24 = radians * (16777216.0F / 6.2831853F);
  return static_cast<Angle>(static_cast<std::int32_t>(turns_q24)) << 8;
}

}  // namespace kinebus::motor
