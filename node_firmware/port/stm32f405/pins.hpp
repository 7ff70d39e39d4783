#pragma once
// Carries out the table of board.hpp.

#include "node_firmware/port/stm32f405/board.hpp"
#include "node_firmware/port/stm32f405/registers.hpp"

namespace kinebus::stm32 {

inline void write(board::Port port, unsigned number, bool high) {
  gpio(static_cast<unsigned>(port)).BSRR = std::uint32_t{1} << (high ? number : number + 16);
}
inline void write(board::OutputPin pin, bool high) {
  write(pin.port, pin.number, high);
}
inline bool read(board::InputPin pin) {
  return (gpio(static_cast<unsigned>(pin.port)).IDR >> pin.number & 1) != 0;
}
inline bool read(board::SwitchPin pin) {
  return (gpio(static_cast<unsigned>(pin.port)).IDR >> pin.line & 1) != 0;
}

/// Pins that are not in the table stay as reset leaves them: inputs, and the debug port.
inline void configure_pins() {
  enable_clock(rcc().AHB1ENR, Rcc::kGpioA | Rcc::kGpioB | Rcc::kGpioC | Rcc::kGpioD | Rcc::kGpioH);
  for (const board::Pin& pin : board::kPins) {
    Gpio& g = gpio(static_cast<unsigned>(pin.port));
    const auto set = [&](Reg& reg, unsigned bits, std::uint32_t value) {
      const unsigned at = (pin.number * bits) % 32;
      const std::uint32_t mask = ((std::uint32_t{1} << bits) - 1) << at;
      reg = (reg & ~mask) | value << at;
    };
    if (pin.mode == board::kOutput) write(pin.port, pin.number, pin.high);
    set(g.AFR[pin.number / 8], 4, pin.alternate);
    set(g.OSPEEDR, 2, pin.mode == board::kAlternate ? 2 : 0);
    set(g.PUPDR, 2, static_cast<std::uint32_t>(pin.pull));
    set(g.MODER, 2, static_cast<std::uint32_t>(pin.mode));
  }
}
static_assert(static_cast<int>(board::kOutput) == 1 && static_cast<int>(board::kAlternate) == 2 &&
              static_cast<int>(board::kAnalogue) == 3 && static_cast<int>(board::kDown) == 2);

}  // namespace kinebus::stm32
