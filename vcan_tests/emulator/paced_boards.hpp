#pragma once
// Emulated boards whose time is given by another program: however busy the computer is, every run is the
// same, frame for frame.

#include <string>
#include <vector>

#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {

/// Joins the boards to who speaks on the standard input, until it ends. Either way go records of 16 bytes,
/// struct can_frame. A frame of the other program is on the bus at once. A record with CAN_ERR_FLAG holds
/// nanoseconds in its 8 data bytes, lowest first: by so much may the boards' time go on, or until they say
/// something. The answer is what they said, and last such a record with their time. Empty: ended well.
/// Otherwise what is wrong.
std::string run_paced(const ElfImage& image, const std::vector<EmulatedNodeOptions>& nodes);

}  // namespace kinebus::emulator
