#pragma once
// Carries out the table of a board.

#include "node_firmware/port/stm32/pin_table.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

namespace kinebus::stm32 {

inline void write(Port port, unsigned number, bool high) {
  gpio(static_cast<unsigned>(port)).BSRR = std::uint32_t{1} << (high ? number : number + 16);
}
inline void write(OutputPin pin, bool high) {
  write(pin.port, pin.number, high);
}
inline bool read(InputPin pin) {
  return (gpio(static_cast<unsigned>(pin.port)).IDR >> pin.number & 1) != 0;
}
inline bool read(SwitchPin pin) {
  return (gpio(static_cast<unsigned>(pin.port)).IDR >> pin.line & 1) != 0;
}

/// Pins that are not in the table stay as reset leaves them: inputs, and the debug port.
template <const auto& kPins>
void configure_pins() {
  constexpr std::uint32_t kPorts = [] {
    std::uint32_t ports = Rcc::gpio_clock(Port::H);  // of the crystal
    for (const Pin& pin : kPins) ports |= Rcc::gpio_clock(pin.port);
    return ports;
  }();
  enable_clock(rcc().AHB1ENR, kPorts);
  for (const Pin& pin : kPins) {
    Gpio& g = gpio(static_cast<unsigned>(pin.port));
    const auto set = [&](Reg& reg, unsigned bits, std::uint32_t value) {
      const unsigned at = (pin.number * bits) % 32;
      const std::uint32_t mask = ((std::uint32_t{1} << bits) - 1) << at;
      reg = (reg & ~mask) | value << at;
    };
    if (pin.mode == Mode::kOutput) write(pin.port, pin.number, pin.high);
    set(g.AFR[pin.number / 8], 4, pin.alternate);
    set(g.OSPEEDR, 2, pin.mode == Mode::kAlternate ? 2 : 0);
    set(g.PUPDR, 2, static_cast<std::uint32_t>(pin.pull));
    set(g.MODER, 2, static_cast<std::uint32_t>(pin.mode));
  }
}
static_assert(static_cast<int>(Mode::kOutput) == 1 && static_cast<int>(Mode::kAlternate) == 2 &&
              static_cast<int>(Mode::kAnalogue) == 3 && static_cast<int>(Pull::kDown) == 2);

}  // namespace kinebus::stm32
