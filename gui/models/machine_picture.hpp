#pragma once
// From what the gateway tells to what the scene draws.

#include <optional>
#include <vector>

#include "gui/scene/machine_model.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

/// nullopt: a machine without a picture.
std::optional<MachineModel> model_of(const joblink::MachineInfo& machine);
PartPose pose_of(const joblink::Status& status);
/// Travel of the carriages, in the order of the model's legs.
std::vector<double> carriages_of(const joblink::MachineInfo& machine, const joblink::Status& status);

}  // namespace kinebus::gui
