#pragma once
// A servo's signal at a pin that a timer's channel 1 drives.

#include "vcan_tests/emulator/peripherals/gpio.hpp"
#include "vcan_tests/emulator/peripherals/timer.hpp"

namespace kinebus::emulator {

struct ServoPulses {
  double width_us = 0, period_us = 0;  ///< 0: none come
};

/// `function`: the alternate one by which the pin is the timer's.
inline ServoPulses servo_pulses(Timer& timer, const GpioPort& port, int pin, int function, bool main_output,
                                Cycle now) {
  constexpr std::uint32_t kReload = 0x2C;
  const Timer::Sweep sweep = timer.sweep();
  const bool out = port.mode(pin) == GpioPort::Mode::kAlternate && port.alternate(pin) == function;
  if (!timer.running() || !out || !sweep.enabled[0] || (main_output && !sweep.main_output)) return {};
  const double period_us = 1e6 * seconds_of(sweep.end - sweep.begin);
  return {period_us * sweep.compare[0] / (timer.read(kReload, now) + 1.0), period_us};
}

}  // namespace kinebus::emulator
