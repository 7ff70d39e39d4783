#pragma once
// How the energy of a recording is spread over frequencies.

#include <cstddef>
#include <vector>

namespace kinebus {

/// Bands of equal width from `from_hz` on.
struct Bands {
  double from_hz = 0, width_hz = 1;
  std::size_t count = 0;
  double middle_hz(std::size_t i) const { return from_hz + (static_cast<double>(i) + 0.5) * width_hz; }
};

/// Integral of |X(f)|^2 over each band, X the Fourier transform of the whole recording less its mean. What is
/// recorded at rest before and after adds its noise alone. Unit: that of the values squared, times s. Cost: n
/// log n.
std::vector<double> energy_spectrum(std::vector<double> values, double period_s, const Bands& bands);

}  // namespace kinebus
