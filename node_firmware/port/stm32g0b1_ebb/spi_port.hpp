#pragma once
// SPI to a chip on the board: bytes in mode 3 at 4 MHz, with bounded waits.

#include <cstdint>
#include <optional>

#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/clock_tree.hpp"
#include "node_firmware/port/stm32g0b1_ebb/pins.hpp"

namespace kinebus::g0b1 {

/// The accelerometer's.
struct Spi2 {
  static Spi& spi() { return spi2(); }
  static void start_clock() { enable_clock(rcc().APBENR1, Rcc::kSpi2); }
  static constexpr stm32::OutputPin kSelect = ebb::kAccelerometer;
};
/// The resistance thermometer's.
struct Spi1 {
  static Spi& spi() { return spi1(); }
  static void start_clock() { enable_clock(rcc().APBENR2, Rcc::kSpi1); }
  static constexpr stm32::OutputPin kSelect = ebb::kResistanceConverter;
};

template <typename Wires>
class SpiPort {
 public:
  static void start() {
    Wires::start_clock();
    Spi& s = Wires::spi();
    s.CR2 = Spi::kBytes | Spi::kByteReceived;
    s.CR1 = Spi::kMode3 | Spi::kMaster | Spi::kDividedBy16 | Spi::kSelected;
    s.CR1 = s.CR1 | Spi::kEnable;
  }
  static void select(bool on) { write(Wires::kSelect, !on); }
  /// nullopt: it stands.
  static std::optional<std::uint8_t> exchange(std::uint8_t byte) {
    Spi& s = Wires::spi();
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
