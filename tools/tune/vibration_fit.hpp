#pragma once
// From spectra to springs: which modes make the tool answer its frame's acceleration as measured.

#include <cstddef>
#include <string>
#include <vector>

#include "gateway/result.hpp"
#include "tools/tune/energy_spectrum.hpp"

namespace kinebus {

/// A spring and damper between frame and tool; `share` of the tool's motion is on it, of all modes 1.
struct FittedMode {
  double frequency_hz = 0;  ///< undamped
  double damping_ratio = 0;
  double share = 1;
};

struct VibrationFit {
  std::vector<FittedMode> modes;  ///< the main one first; a second one where it explains more
  double gain = 1;                ///< of the accelerometer, to the plan
  double error_db = 0;            ///< rms of the spectrum against the model
  Bands bands;
  std::vector<double> measured, modelled;  ///< of each band: how many times the frame's acceleration
};

/// `planned`, `measured`: energy of the acceleration in each band. Noise that is equal at all frequencies is
/// found as well. Error: nothing that swings is seen in these bands.
Result<VibrationFit, std::string> fit_vibration(const Bands& bands, const std::vector<double>& planned,
                                                const std::vector<double>& measured);

/// How many times a frame's acceleration its tool feels at a frequency: |sum of share * transmissibility|.
double transmissibility(const std::vector<FittedMode>& modes, double frequency_hz);

}  // namespace kinebus
