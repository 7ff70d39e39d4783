#pragma once
// The first print of a machine: small, slow, and with all that a set-up has tested.

#include <string>

#include "gateway/description/machine_description.hpp"

namespace kinebus {

/// A flat square of 30 mm around the middle, two layers, some 40 s after it is hot: heats what the machine
/// has, cools with the first fan on the second layer, and ends cold and clear of the part. Without a hot end
/// it feeds nothing.
std::string demo_print(const MachineDescription& machine);

}  // namespace kinebus
