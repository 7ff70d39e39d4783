#pragma once
// Emulated boards on a real CAN bus, by the wall clock.

#include <string>
#include <vector>

#include "vcan_tests/can_port/can_port.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {

struct LiveOptions {
  /// The boards' time slips as soon as they are so late. The less of it, the sooner a slow computer's boards
  /// answer.
  BusTime most_behind{0};
  /// The boards have power while this file exists; empty: always. Flash is kept without.
  std::string power_file;
  /// Where a person's eyes and hands are files (workbench.hpp); empty: nobody looks.
  std::string bench_folder;
};

/// Joins the boards to the bus until SIGINT, SIGTERM or the other end of `bus` is gone. Empty: ended well.
/// Otherwise what is wrong. The boards run a millisecond behind the wall clock, so that a frame is received
/// at the cycle that its time stamp names; a lab's clock (lab_clock.hpp) waits for them. By how much a slow
/// computer made the boards' time slip is told at the end.
std::string run_live(const ElfImage& image, const std::vector<EmulatedNodeOptions>& nodes, CanPort& bus,
                     const LiveOptions& options);

}  // namespace kinebus::emulator
