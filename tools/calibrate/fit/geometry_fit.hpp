#pragma once
// A machine's deviations from readings of its tool: robust least squares that says what it cannot know.

#include <functional>
#include <string>
#include <vector>

#include "tools/calibrate/fit/geometry_model.hpp"

namespace kinebus {

struct GeometryFitOptions {
  bool switch_offsets_only = false;  ///< paper M5: straightness by the switches alone (and the table's tilt)
  bool rail_lean = true;
  bool scale = false;  ///< also the rails' scale; better measured along each rail
};

struct FittedParameter {
  std::string name, unit;
  double value = 0;
  double sigma = 0;   ///< standard deviation, from the readings' scatter
  bool held = false;  ///< the readings do not determine it: held at 0
  std::string why;    ///< for a held one: "goes with leg1 switch offset"
};

struct GeometryFit {
  bool solved = false;
  std::string problem;  ///< in words, when not solved
  MachineDeviation deviation;
  std::vector<FittedParameter> parameters;  ///< all that were asked for, the machine's first
  std::vector<double> before_mm, after_mm;  ///< residuals; before: with only zeros and balls fitted
  double before_rms_mm = 0, after_rms_mm = 0;
  std::size_t outliers = 0;
  int steps = 0;
};

GeometryFit fit_geometry(const GeometryModel& model, const GeometryFitOptions& options);

/// The `count` of `candidates` that would tell most, in their order of use: each is the one that raises the
/// determinant of the information most, given the readings that are there and those chosen before. Touch
/// probe readings of X, Y and Z with `sigma_mm` are assumed.
std::vector<Pose> suggest_poses(const BelievedMachine& machine, const std::vector<GeometryReading>& present,
                                const std::vector<Pose>& candidates, std::size_t count, double sigma_mm,
                                const GeometryFitOptions& options);

}  // namespace kinebus
