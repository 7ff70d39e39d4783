#pragma once
// Carries out the table of the board.

#include "node_firmware/port/stm32g0b1_ebb/registers.hpp"

namespace kinebus::g0b1 {

inline void write(stm32::OutputPin pin, bool high) {
  gpio(static_cast<unsigned>(pin.port)).BSRR = std::uint32_t{1} << (high ? pin.number : pin.number + 16);
}
inline bool read(stm32::SwitchPin pin) {
  return (gpio(static_cast<unsigned>(pin.port)).IDR >> pin.line & 1) != 0;
}

/// Pins that are not in the table stay as reset leaves them: analogue, and the debug port.
template <const auto& kPins>
void configure_pins() {
  constexpr std::uint32_t kPorts = [] {
    std::uint32_t ports = 0;
    for (const stm32::Pin& pin : kPins) ports |= Rcc::gpio_clock(pin.port);
    return ports;
  }();
  enable_clock(rcc().IOPENR, kPorts);
  for (const stm32::Pin& pin : kPins) {
    Gpio& g = gpio(static_cast<unsigned>(pin.port));
    const auto set = [&](Reg& reg, unsigned bits, std::uint32_t value) {
      const unsigned at = (pin.number * bits) % 32;
      reg = (reg & ~(((std::uint32_t{1} << bits) - 1) << at)) | value << at;
    };
    if (pin.mode == stm32::Mode::kOutput) write({pin.port, pin.number}, pin.high);
    set(g.AFR[pin.number / 8], 4, pin.alternate);
    set(g.OSPEEDR, 2, pin.mode == stm32::Mode::kAlternate ? 2 : 0);
    set(g.PUPDR, 2, static_cast<std::uint32_t>(pin.pull));
    set(g.MODER, 2, static_cast<std::uint32_t>(pin.mode));
  }
}

}  // namespace kinebus::g0b1
