#pragma once
// Emulated boards on a real CAN interface, by the wall clock.

#include <string>
#include <vector>

#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {

/// Joins the boards to `interface` until SIGINT or SIGTERM. SIGUSR1: the power of all boards goes for a
/// moment. Empty: ended well. Otherwise what is wrong. The boards run a millisecond behind the wall clock, so
/// that a frame is received at the cycle that its kernel time stamp names. A computer that is too slow makes
/// the boards' time slip as soon as they are `most_behind` late; by how much is told at the end. The less of
/// it, the sooner a slow computer's boards answer.
std::string run_live(const ElfImage& image, const std::vector<EmulatedNodeOptions>& nodes,
                     const std::string& interface, BusTime most_behind);

}  // namespace kinebus::emulator
