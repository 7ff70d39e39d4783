#pragma once
// What has to be true of a joint that homes at its mechanical stop, by the load that its motor's driver sees.

#include <string>
#include <vector>

#include "gateway/description/machine_rules.hpp"

namespace kinebus {

/// The keys of [joint.X.homing]. `key`: "joint.X.homing."
void judge_load_keys(const JointDescription& joint, const HomingDescription& homing, const std::string& key,
                     std::vector<BrokenRule>& broken);

/// A joint that first goes off its stop must not bring the tool to the table by that. The description must be
/// one that has kinematics.
void judge_load_homing(const MachineDescription& description, std::vector<BrokenRule>& broken);

}  // namespace kinebus
