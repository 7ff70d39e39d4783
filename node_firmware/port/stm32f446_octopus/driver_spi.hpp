#pragma once
// The drivers' SPI: SPI1 for all sockets, mode 3 at 1.3 MHz, the wire of a socket's UART as its select. A
// datagram takes 31 us, in which the main loop waits: steps need no instruction and interrupts go on.

#include <array>
#include <cstdint>
#include <span>

#include "node_firmware/port/stm32f446_octopus/board.hpp"
#include "node_firmware/step/driver_chain.hpp"

namespace kinebus::stm32 {

class DriverSpi {
 public:
  /// After the pins were configured.
  static void start();
  void exchange(OutputPin select, std::span<const std::uint8_t> said);
  std::size_t take(std::span<std::uint8_t> heard) const;

 private:
  std::array<std::uint8_t, step::kMostHeard> heard_{};
  std::size_t came_ = 0;
};

}  // namespace kinebus::stm32
