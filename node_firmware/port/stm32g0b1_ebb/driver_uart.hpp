#pragma once
// The wire to the driver's UART: USART2 on one wire at 40 kbaud. What is said fits into its FIFO, and DMA1's
// channel 2 keeps what is heard: no interrupt, and the main loop may come late.

#include <array>
#include <cstdint>
#include <span>

#include "node_firmware/step/driver_chain.hpp"

namespace kinebus::g0b1 {

class DriverUart {
 public:
  /// After the pins were configured.
  static void start();
  void begin(std::size_t driver, const step::Exchange& exchange);
  bool done() const;
  std::size_t take(std::span<std::uint8_t> heard) const;

 private:
  std::array<std::uint8_t, step::kMostHeard> heard_{};  // written by DMA
};
static_assert(step::DriverWire<DriverUart>);

}  // namespace kinebus::g0b1
