#pragma once
// An emulated board at this computer's own USB.

#include <string>

#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {

/// The first board's connector at this computer's vhci_hcd until SIGINT or SIGTERM, as quickly as the
/// computer can and by the wall clock at most. Empty: ended well. Otherwise what is wrong.
std::string run_usb(const ElfImage& image, const EmulatedNodeOptions& node);

}  // namespace kinebus::emulator
