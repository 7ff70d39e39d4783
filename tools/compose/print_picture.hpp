#pragma once
// The job being printed, as a person before the machine sees it: the nozzle stands still, the table tilts and
// turns below it, and what is printed so far stands on the table, strand by strand.

#include <string>

#include "gateway/description/machine_description.hpp"
#include "tools/compose/joiner.hpp"
#include "tools/compose/nozzle.hpp"

namespace kinebus::compose {

struct PrintPictureOptions {
  Nozzle nozzle;
  double table_radius_mm = 100;
  double strand_mm = 0.5;       ///< width of a strand as drawn
  double part_of_piece = 0.65;  ///< how much of its own piece each panel shows
};

/// An SVG with a panel for each piece (of more than four: the first, the last and two between), read from the
/// job by the gateway's own interpreter.
std::string print_picture(const std::string& title, const JoinedJob& job, const MachineDescription& machine,
                          const PrintPictureOptions& options);

}  // namespace kinebus::compose
