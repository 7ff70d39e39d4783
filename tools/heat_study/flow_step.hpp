#pragma once
// A hot end at its temperature, a step of filament through it and its end: what the block does under each
// control. A real heat node's core, tuned by its own measurement, and the plant that hangs on virtual nodes.

#include <string_view>
#include <vector>

namespace kinebus::heat_study {

struct Scene {
  double target_c = 210;
  double flow_mm3_per_s = 24;
  double before_s = 20, flowing_s = 60, after_s = 60;
  /// What the master believes; the plant's is 0.0023.
  double filament_j_per_mm3_k = 0.0021;
};

enum class Control { kPid, kModel, kModelAhead };
std::string_view words(Control control);

struct Sample {
  double t_s = 0;    ///< 0: the flow begins
  double off_k = 0;  ///< block less target
  double power_w = 0;
};
struct Run {
  std::vector<Sample> samples;  ///< ten a second
  double lowest_k = 0, highest_k = 0;
};

/// Throws std::runtime_error: the node refuses something, or its measurement fails.
Run flow_step(const Scene& scene, Control control);

}  // namespace kinebus::heat_study
