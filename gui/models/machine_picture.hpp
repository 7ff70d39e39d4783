#pragma once
// From what the gateway tells to what the scene draws.

#include <optional>

#include "gateway/gcode/interpreter.hpp"
#include "gui/scene/machine_model.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

/// nullopt: a machine without a picture.
std::optional<MachineModel> model_of(const joblink::MachineInfo& machine);
/// What the gateway told of the machine, for reading its jobs; the rest as the machine file has it by
/// default.
gcode::Options reading_options(const joblink::MachineInfo& machine);
kinebus::Pose to_pose(const joblink::Pose& pose);
PartPose pose_of(const joblink::Status& status);

}  // namespace kinebus::gui
