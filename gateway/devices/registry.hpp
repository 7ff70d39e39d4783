#pragma once
// From the machine file to its devices: who stands behind each.

#include "gateway/description/machine_description.hpp"
#include "gateway/devices/devices.hpp"
#include "gateway/result.hpp"

namespace kinebus {

/// All devices that the description states. Error: one that lives where no implementation of its kind does.
Result<Devices, Sentence> make_devices(const MachineDescription& machine);

}  // namespace kinebus
