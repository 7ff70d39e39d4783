#pragma once
// Carries out the table of the board.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "node_firmware/port/stm32g0b1_ebb/registers.hpp"

namespace kinebus::g0b1 {

inline void write(stm32::OutputPin pin, bool high) {
  gpio(static_cast<unsigned>(pin.port)).BSRR = std::uint32_t{1} << (high ? pin.number : pin.number + 16);
}
inline bool read(stm32::SwitchPin pin) {
  return (gpio(static_cast<unsigned>(pin.port)).IDR >> pin.line & 1) != 0;
}

/// A pin of a table without its name, which would take flash.
struct PinSetting {
  stm32::Port port;
  std::uint8_t number;
  stm32::Mode mode;
  stm32::Pull pull;
  std::uint8_t alternate;
  bool high;
};
inline void configure(std::span<const PinSetting> pins) {
  for (const PinSetting& pin : pins) {
    enable_clock(rcc().IOPENR, Rcc::gpio_clock(pin.port));
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
/// Pins that are not in the table stay as reset leaves them: analogue, and the debug port.
template <const auto& kPins>
void configure_pins() {
  static constexpr auto kSettings = [] {
    std::array<PinSetting, kPins.size()> settings{};
    for (std::size_t i = 0; i < settings.size(); ++i) {
      const stm32::Pin& pin = kPins[i];
      settings[i] = {pin.port, pin.number, pin.mode, pin.pull, pin.alternate, pin.high};
    }
    return settings;
  }();
  configure(kSettings);
}

}  // namespace kinebus::g0b1
