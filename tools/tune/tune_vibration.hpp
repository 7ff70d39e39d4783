#pragma once
// From recordings of a shaken tool to [vibration] of the machine file: spectra, springs, a shaper for each
// direction or for all.

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "tools/simulation/flexible_frame.hpp"
#include "tools/tune/acceleration_readings.hpp"
#include "tools/tune/node_spectrum.hpp"
#include "tools/tune/shaper_choice.hpp"
#include "tools/tune/vibration_excitation.hpp"

namespace kinebus {

struct TuneVibration {
  Excitation excitation;    ///< its axis aside
  double deviation_mm = 0;  ///< ShaperQuestion; 0: what the machine file says
  double slowest_rate = 0;  ///< the same
};

/// Of a tool that was shaken along one direction.
using VibrationRecording = std::variant<AccelerationReadings, NodeSpectrum>;

struct AxisTuning {
  std::optional<VibrationFit> fit;  ///< none: not measured, or nothing swings
  std::string problem;              ///< then
  std::vector<ShaperRating> ratings;
  std::size_t best = 0;  ///< of them
};

struct VibrationTuning {
  std::array<AxisTuning, 3> axes;  ///< X Y Z
  bool shared = false;             ///< one shaper for all: each axis has the same ratings
  MachineDescription machine;      ///< with what was found
};

/// `readings`: of each axis while it was shaken; none: that axis stays as it is, or goes along with the
/// others where they share a shaper. Error: the excitation cannot be planned on this machine.
Result<VibrationTuning, std::string> tune_vibration(
    const MachineDescription& machine, const TuneVibration& how,
    const std::array<std::optional<VibrationRecording>, 3>& readings);

/// Shakes the simulated machine, whose frame is `truth`, and records the tool with an accelerometer. Error:
/// the job came to no good end.
Result<AccelerationReadings, std::string> shake_simulated(const MachineDescription& machine,
                                                          const Excitation& excitation,
                                                          const std::array<FlexibleFrame::Modes, 3>& truth,
                                                          std::uint64_t seed);

nlohmann::json to_json(const VibrationTuning& tuning);
std::string to_table(const VibrationTuning& tuning);
/// Spectra, what was fitted, and what the shaper lets through (SVG).
std::string draw_tuning(const VibrationTuning& tuning);

}  // namespace kinebus
