#pragma once
// What a machine would plan for a text, phase by phase, without running it.

#include <functional>

#include "gateway/description/machine_description.hpp"
#include "gateway/jobs/byte_source.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus {

/// Calls `take` with each phase in turn; what is refused is left out. limit_s: of motion; 0: all of it.
void for_each_phase(const MachineDescription& machine, const Kinematics& kinematics, ByteSource& text,
                    double limit_s, const std::function<void(const Phase&)>& take);

}  // namespace kinebus
