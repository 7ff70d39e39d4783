#pragma once
// What the keys of [bodies] must be to each other, and what a machine with these bodies must be able to do:
// to stand somewhere, and there with room between them.

#include <string>
#include <vector>

#include "gateway/description/machine_rules.hpp"

namespace kinebus {

/// Appends what is broken. `kinematics`: of the description.
void judge_bodies(const MachineDescription& description, const Kinematics& kinematics,
                  std::vector<BrokenRule>& broken);

/// A machine that may stand at no pose of its workspace, and not at its bed reference either, can do nothing;
/// nor could anything be said of how it homes.
void judge_reach(const MachineDescription& description, const Kinematics& kinematics,
                 std::vector<BrokenRule>& broken);

/// "X 10 Y 0 Z 20 A 45"
std::string pose_text(const Pose& pose);

}  // namespace kinebus
