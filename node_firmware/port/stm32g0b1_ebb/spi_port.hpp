#pragma once
// SPI2, to the accelerometer on the board: bytes in mode 3 at 4 MHz, with bounded waits.

#include <cstdint>
#include <optional>

#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/clock_tree.hpp"
#include "node_firmware/port/stm32g0b1_ebb/pins.hpp"

namespace kinebus::g0b1 {

class SpiPort {
 public:
  static void start() {
    enable_clock(rcc().APBENR1, Rcc::kSpi2);
    Spi& s = spi2();
    s.CR2 = Spi::kBytes | Spi::kByteReceived;
    s.CR1 = Spi::kMode3 | Spi::kMaster | Spi::kDividedBy16 | Spi::kSelected;
    s.CR1 = s.CR1 | Spi::kEnable;
  }
  static void select(bool on) { write(ebb::kAccelerometer, !on); }
  /// nullopt: it stands.
  static std::optional<std::uint8_t> exchange(std::uint8_t byte) {
    Spi& s = spi2();
    // A wider store would be two bytes.
    *reinterpret_cast<volatile std::uint8_t*>(&s.DR) = byte;
    if (!wait_until([&] { return (s.SR & Spi::kReceived) != 0; }, 1000)) return std::nullopt;
    return *reinterpret_cast<volatile std::uint8_t*>(&s.DR);
  }
  static void wait_us(unsigned us) {
    const std::uint32_t from = local_counts(), counts = us * (kLocalHz / 1'000'000);
    static_cast<void>(wait_until([&] { return local_counts() - from > counts; }));
  }
};

}  // namespace kinebus::g0b1
