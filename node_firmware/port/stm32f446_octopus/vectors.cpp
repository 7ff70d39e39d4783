// Which interrupt of the STM32F446 has which handler.

#include "node_firmware/port/stm32f4/vectors.hpp"

namespace kinebus::stm32 {
namespace {

constexpr VectorTable<97> make_vectors() {
  VectorTable<97> table;
  table.at(Irq::kExti9To5) = isr_switches;
  table.at(Irq::kExti15To10) = isr_switches;
  table.at(Irq::kDma2Stream1) = isr_control;
  table.at(Irq::kOtgFs) = isr_usb;
  return table;
}

[[gnu::section(".vectors"), gnu::used]] constinit const VectorTable<97> kVectors = make_vectors();

}  // namespace
}  // namespace kinebus::stm32
