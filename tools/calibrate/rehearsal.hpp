#pragma once
// A calibration from end to end on a machine with hidden errors: what a person does, by the texts of files.

#include <cstdint>

#include "gateway/description/machine_description.hpp"
#include "gateway/result.hpp"

namespace kinebus {

struct Rehearsal {
  double rail_step_mm = 3;
  int points = 120;  ///< poses that the touch probe reads
  double noise_mm = 0.01;
  double pitch_mm = 0;  ///< of the screws; 0: no periodic error is looked for
  std::uint64_t seed = 1;
};

/// Measures the rails of `truth` forth and back and fits them, then touches points and fits the geometry.
/// Returns `machine` with the calibration found; its four legs carry all that is measured.
Result<MachineDescription, std::string> calibrated(const MachineDescription& machine,
                                                   const MachineDescription& truth,
                                                   const Rehearsal& rehearsal);

}  // namespace kinebus
