#pragma once
// What the machine description means for a heat node's object dictionary.

#include "gateway/bus_nodes/node_configuration.hpp"

namespace kinebus {

/// Adds the settings of all heaters, sensors, those of filament too, and fans of the node; those that the
/// machine file does not name are switched off.
void add_heat_settings(const MachineDescription& machine, std::uint8_t node_id,
                       NodeConfiguration& configuration);

}  // namespace kinebus
