#pragma once
// What a heat node's accelerometer has felt, as its node sums it up (node_firmware/heat/vibration_meter.hpp):
// energy over frequency, of windows of 1024 decimated readings.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/result.hpp"
#include "tools/tune/energy_spectrum.hpp"

namespace kinebus {

struct NodeSpectrum {
  static constexpr int kDecimation = 8;
  static constexpr std::size_t kPoints = 1024, kHop = kPoints / 4;

  double rate_hz = 0;  ///< of the chip's readings
  std::uint32_t windows = 0, clipped = 0;
  std::vector<std::array<double, 3>> energy;  ///< along X Y Z, of each band from 0 Hz on

  double period_s() const { return kDecimation / rate_hz; }
  /// Its bands within these frequencies.
  Bands bands(double from_hz, double to_hz) const;
  std::vector<double> of(std::size_t axis, const Bands& bands) const;
};

/// As M956 tells it: a line "rate_hz R windows W clipped C", then a line "x,y,z" for each band. Error: the
/// line and what is wrong with it; fewer than 100 bands; a thousandth of the readings or more clipped.
Result<NodeSpectrum, std::string> read_node_spectrum(std::string_view text);

/// The same of values whose every one is the mean over `spectrum`'s period_s(), as that node would have
/// summed them up: in `bands`, by its windows and its decimation.
std::vector<double> as_the_node(const std::vector<double>& values, const NodeSpectrum& spectrum,
                                const Bands& bands);

}  // namespace kinebus
