#pragma once
// Heaters, fans, outputs and sensors that live on heat nodes.

#include <cstdint>
#include <map>
#include <memory>

#include "gateway/description/machine_description.hpp"
#include "gateway/devices/heat_node_link.hpp"

namespace kinebus {

/// The heat nodes of a machine, each once.
using HeatNodeLinks = std::map<std::uint8_t, std::shared_ptr<HeatNodeLink>>;
HeatNodeLinks heat_node_links(const MachineDescription& machine);

// For the registry; nullptr: there is no such heat node, or it has no such channel.
std::unique_ptr<Heater> on_heat_node(const HeaterDescription& heater, const MachineDescription& machine,
                                     const HeatNodeLinks& links);
std::unique_ptr<Output> on_heat_node(const FanDescription& fan, const MachineDescription& machine,
                                     const HeatNodeLinks& links);
std::unique_ptr<Output> on_heat_node(const OutputDescription& output, const MachineDescription& machine,
                                     const HeatNodeLinks& links);
std::unique_ptr<Sensor> on_heat_node(const SensorDescription& sensor, const MachineDescription& machine,
                                     const HeatNodeLinks& links);
std::unique_ptr<FilamentSensor> on_heat_node(const FilamentSensorDescription& sensor,
                                             const MachineDescription& machine, const HeatNodeLinks& links);
std::unique_ptr<VibrationSensor> on_heat_node(const AccelerometerDescription& accelerometer,
                                              const HeatNodeLinks& links);

}  // namespace kinebus
