#pragma once
// An emulated board at a computer's USB, by the wall clock.

#include <string>
#include <vector>

#include "vcan_tests/emulator/emulated_machine.hpp"
#include "vcan_tests/emulator/live_boards.hpp"
#include "vcan_tests/emulator/usb_line.hpp"

namespace kinebus::emulator {

/// The first board's connector at this line until SIGINT, SIGTERM or the line's end; the others are on its
/// CAN bus. As quickly as the computer can, and by the wall clock at most; of `options` lateness and bench.
/// Empty: ended well. Otherwise what is wrong.
std::string run_usb(const ElfImage& image, const std::vector<EmulatedNodeOptions>& boards, UsbLine& line,
                    const LiveOptions& options);

}  // namespace kinebus::emulator
