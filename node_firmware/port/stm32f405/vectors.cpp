// Which interrupt of the STM32F405 has which handler.

#include "node_firmware/port/stm32f4/vectors.hpp"

namespace kinebus::stm32 {
namespace {

constexpr VectorTable<82> make_vectors() {
  VectorTable<82> table;
  for (const Irq irq : {Irq::kExti0, Irq::kExti1, Irq::kExti3, Irq::kExti4, Irq::kExti9To5, Irq::kExti15To10})
    table.at(irq) = isr_switches;
  table.at(Irq::kAdc) = isr_control;
  table.at(Irq::kTim1Break) = isr_break_a;
  table.at(Irq::kTim8Break) = isr_break_b;
  table.at(Irq::kUsart1) = isr_console;
  return table;
}

[[gnu::section(".vectors"), gnu::used]] constinit const VectorTable<82> kVectors = make_vectors();

}  // namespace
}  // namespace kinebus::stm32
