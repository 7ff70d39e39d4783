#pragma once
// The vector table: a port says which of its interrupts has which handler, and keeps it in the section
// .vectors.

#include <cstdint>

#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

extern "C" {
extern std::uint32_t stack_top;  // set by the linker script
}

namespace kinebus::stm32 {

using Handler = void (*)();

/// kInterrupts: so many the chip has.
template <int kInterrupts>
struct VectorTable {
  std::uint32_t* stack = &stack_top;
  Handler core[15] = {};
  Handler interrupts[kInterrupts] = {};

  constexpr VectorTable() {
    for (Handler& handler : core) handler = isr_fault;
    for (Handler& handler : interrupts) handler = isr_unexpected;
    core[0] = reset_handler;
    core[14] = isr_tick;
    at(Irq::kCan1Rx0) = isr_can_receive;
    at(Irq::kCan1Tx) = isr_can_transmit;
    at(Irq::kCan1Sce) = isr_can_state;
  }
  constexpr Handler& at(Irq irq) { return interrupts[static_cast<int>(irq)]; }
};

}  // namespace kinebus::stm32
