// Which interrupt of the STM32G0B1 has which handler.

#include <cstdint>

#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32g0b1_ebb/registers.hpp"

extern "C" {
extern std::uint32_t stack_top;  // set by the linker script
void isr_nmi();
}

namespace kinebus::g0b1 {
namespace {

using Handler = void (*)();

struct VectorTable {
  std::uint32_t* stack = &stack_top;
  Handler core[15] = {};
  Handler interrupts[31] = {};

  constexpr VectorTable() {
    for (Handler& handler : core) handler = isr_fault;
    for (Handler& handler : interrupts) handler = isr_unexpected;
    core[0] = reset_handler;
    core[1] = isr_nmi;
    core[14] = isr_tick;
    for (const Irq irq : {Irq::kExti0To1, Irq::kExti2To3, Irq::kExti4To15}) at(irq) = isr_switches;
    at(Irq::kDma1Channel1) = isr_control;
    at(Irq::kCan0) = isr_can_receive;
    at(Irq::kCan1) = isr_can_state;
  }
  constexpr Handler& at(Irq irq) { return interrupts[static_cast<int>(irq)]; }
};

[[gnu::section(".vectors"), gnu::used]] constinit const VectorTable kVectors;

}  // namespace
}  // namespace kinebus::g0b1
