#pragma once
// Where the image's cycles go: what `kinebus-emulate` prints.

#include <string>

#include "vcan_tests/emulator/board.hpp"

namespace kinebus::emulator {

/// Interrupts by name with instructions and estimated cycles, idle share and deepest stack since the costs
/// were cleared at `began` with `idle_before` cycles of idleness.
std::string cost_table(const Board& board, Cycle began, Cycle idle_before);
/// The functions that took most cycles since start_profile().
std::string profile_table(const Board& board, std::size_t functions);

}  // namespace kinebus::emulator
