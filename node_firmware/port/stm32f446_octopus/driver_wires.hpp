#pragma once
// What leads to the drivers' sockets: a wire each, which is a UART or the select of the SPI that all share.

#include "node_firmware/port/stm32f446_octopus/driver_spi.hpp"
#include "node_firmware/port/stm32f446_octopus/driver_wire.hpp"

namespace kinebus::stm32 {

class DriverWires {
 public:
  /// After the pins were configured.
  static void start() {
    DriverWire::start();
    DriverSpi::start();
  }
  void begin(std::size_t driver, const step::Exchange& exchange) {
    by_spi_ = exchange.bus == step::DriverBus::kSpi;
    if (by_spi_)
      spi_.exchange(octopus::kDrivers[driver].uart, exchange.said());
    else
      uart_.begin(driver, exchange.said(), exchange.hears - exchange.length);
  }
  bool done() const { return by_spi_ || uart_.done(); }
  std::size_t take(std::span<std::uint8_t> heard) { return by_spi_ ? spi_.take(heard) : uart_.take(heard); }

 private:
  DriverWire uart_;
  DriverSpi spi_;
  bool by_spi_ = false;
};
static_assert(step::DriverWire<DriverWires>);

using OctopusDrivers = step::DriverChain<DriverWires, octopus::kDrivers.size()>;

}  // namespace kinebus::stm32
