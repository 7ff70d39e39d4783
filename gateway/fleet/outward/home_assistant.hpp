#pragma once
// What Home Assistant reads: a configuration for each machine (its MQTT discovery), kept by the broker, and
// states as JSON.

#include <string>

#include "gateway/fleet/machine_view.hpp"
#include "gateway/fleet/outward/message.hpp"

namespace kinebus::fleet {

/// One device with its state, job and progress.
MqttMessage home_assistant_device(const std::string& group, const Machine& machine);
MqttMessage home_assistant_state(const std::string& group, const MachineView& view);

}  // namespace kinebus::fleet
