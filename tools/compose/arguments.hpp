#pragma once
// What kinebus-compose is told on the command line, and what that means. Errors are exceptions with words.

#include <optional>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "tools/compose/composer.hpp"

namespace kinebus::compose {

struct Arguments {
  std::string input, output, machine, config, program = "prusa-slicer", report, picture, printing, work,
                                              nozzle;
  std::vector<std::string> planes;
  std::optional<double> max_tilt_deg;  // else the machine's
  double max_overhang_deg = 45, layer_mm = 0.2, clearance_mm = 20, table_radius_mm = 100;
  bool keep_position = false, no_support_comparison = false;
};

/// The machine of the file, else the default one.
MachineDescription machine_of(const Arguments& arguments);
ComposeOptions options_of(const Arguments& arguments, const MachineDescription& machine);
/// A machine that does not tilt makes no pieces of its own.
void require_tilt(const ComposeOptions& options);

}  // namespace kinebus::compose
