#pragma once
// The machine's bodies at four poses as one picture (SVG).

#include <string>

#include "gateway/bodies/collision_model.hpp"
#include "tools/workspace/scan.hpp"

namespace kinebus::workspace {

/// Level and low, at both ends of the tilt, and where two bodies are nearest of all poses of the room that
/// the rules allow. The two that are nearest are red, with their distance below.
std::string draw_bodies(const bodies::CollisionModel& model, const Kinematics& kinematics, const Room& room,
                        const std::string& title);

}  // namespace kinebus::workspace
