#pragma once
// What the keys of devices and of the nodes that carry them must be to each other.

#include <vector>

#include "gateway/description/machine_rules.hpp"

namespace kinebus {

/// Appends what is broken.
void judge_devices(const MachineDescription& description, std::vector<BrokenRule>& broken);

}  // namespace kinebus
