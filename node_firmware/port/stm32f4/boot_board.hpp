#pragma once
// What of a boot loader is its board's: each port has these, and boot_main.cpp does the rest.

#include <cstdint>
#include <span>

#include "node_firmware/boot/boot_loader.hpp"

namespace kinebus::stm32::boot_board {

extern const ImageTarget kTarget;
/// Where the vectors of the boot loader and of the program are.
extern const std::uint32_t kVectors, kProgram;

/// Before all else: the chip is as after a reset, and the handover as it was left.
void begin();
void configure_pins();
/// fault_reason::kNone, or why it does not run.
std::uint16_t start_clocks();
ProgramFlash& program_flash();
/// Of the board's first node; empty: none.
std::span<const std::uint8_t> stored_parameters();
void show(bool lit);
/// What the board has to switch for the chip's own boot loader.
void select_system_boot();

}  // namespace kinebus::stm32::boot_board
