#include "tools/tune/energy_spectrum.hpp"

#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <utility>

namespace kinebus {
namespace {

using Complex = std::complex<double>;

/// Cooley and Tukey 1965, in place; the size is a power of two.
void fourier_transform(std::vector<Complex>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; (j & bit) != 0; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t half = 1; half < n; half *= 2) {
    std::vector<Complex> turns(half);
    for (std::size_t k = 0; k < half; ++k)
      turns[k] = std::polar(1.0, -std::numbers::pi * static_cast<double>(k) / static_cast<double>(half));
    for (std::size_t i = 0; i < n; i += 2 * half)
      for (std::size_t k = 0; k < half; ++k) {
        const Complex a = x[i + k], b = x[i + k + half] * turns[k];
        x[i + k] = a + b;
        x[i + k + half] = a - b;
      }
  }
}

}  // namespace

std::vector<double> energy_spectrum(std::vector<double> values, double period_s, const Bands& bands) {
  std::vector<double> energy(bands.count, 0.0);
  if (values.empty()) return energy;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  std::vector<Complex> x(std::bit_ceil(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) x[i] = period_s * (values[i] - mean);
  fourier_transform(x);
  const double step_hz = 1 / (period_s * static_cast<double>(x.size()));
  for (std::size_t k = 0; k < x.size() / 2; ++k) {
    const double band = (static_cast<double>(k) * step_hz - bands.from_hz) / bands.width_hz;
    if (band < 0 || band >= static_cast<double>(bands.count)) continue;
    energy[static_cast<std::size_t>(band)] += std::norm(x[k]) * step_hz;
  }
  return energy;
}

}  // namespace kinebus
