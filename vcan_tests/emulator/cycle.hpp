#pragma once
// The emulated node's own time: processor cycles since power-up.

#include <cstdint>
#include <limits>

namespace kinebus::emulator {

using Cycle = std::uint64_t;
constexpr Cycle kNever = std::numeric_limits<Cycle>::max();
/// SYSCLK once the firmware has set the clock tree. The emulation runs at it from the first instruction on:
/// the few microseconds on the slow internal oscillator are not told apart.
constexpr Cycle kCoreHz = 168'000'000;
constexpr Cycle kApb1Divider = 4, kApb2Divider = 2;  ///< CAN and SPI2/3 at 42 MHz, SPI1 and ADC at 84 MHz

constexpr double seconds_of(Cycle cycles) {
  return static_cast<double>(cycles) / static_cast<double>(kCoreHz);
}

}  // namespace kinebus::emulator
