#pragma once
// `kinebus plan --home`: in which order and direction the joints home, why, and what comes near on the way.

#include <cstdint>
#include <string>

#include "gateway/description/machine_description.hpp"

namespace kinebus {

struct HomePlanArguments {
  int starts = 1000;
  std::uint64_t seed = 1;
  double part_radius_mm = 0, part_height_mm = 0;  ///< 0: the machine file's, or the workspace's
  std::string json_path;
};

/// Prints it. 0: from no start do bodies touch.
int plan_homing(const MachineDescription& machine, const HomePlanArguments& arguments);

}  // namespace kinebus
