#pragma once
// What the motion of a job prints.

#include "gateway/bodies/printed_part.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus {

/// Adds what a phase prints, if its filament is fed while the tool moves. `end`: the phase's piece at its
/// end.
void trace_print(const Phase& phase, const PosePoint& end, bodies::PrintedPart& part);

}  // namespace kinebus
