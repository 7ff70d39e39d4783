#include "node_firmware/port/stm32f446_octopus/driver_spi.hpp"

#include <algorithm>

#include "node_firmware/port/stm32f4/clocks.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"

namespace kinebus::stm32 {
namespace {

// 2^6: 1.3 MHz. The chips take 4 MHz by their own clock; the level shifter in MISO is slow.
constexpr unsigned kDivider = 6;
static_assert(2 * kApb2Hz >> (kDivider + 1) < 4'000'000);
constexpr std::uint32_t kLongest = 20 * (kLocalHz / 1'000'000);  // a byte takes 6 us

bool wait_for(std::uint32_t flag, bool set) {
  const auto reached = [&] { return ((spi1().SR & flag) != 0) == set; };
  const std::uint32_t from = local_counts();
  while (!reached())
    if (local_counts() - from > kLongest) return reached();  // an interrupt may have taken the time
  return true;
}

}  // namespace

void DriverSpi::start() {
  enable_clock(rcc().APB2ENR, Rcc::kSpi1);
  Spi& s = spi1();
  s.CR2 = 0;
  s.CR1 = Spi::kSecondEdge | Spi::kRestsHigh | Spi::kMaster | Spi::kSoftwareSelect | Spi::kInternalSelect |
          Spi::divide(kDivider);
  s.CR1 = s.CR1 | Spi::kEnable;
}

void DriverSpi::exchange(OutputPin select, std::span<const std::uint8_t> said) {
  // Driven both ways: a select that rises by a resistor is no edge.
  Gpio& port = gpio(static_cast<unsigned>(select.port));
  port.OTYPER = port.OTYPER & ~bit(select.number);
  Spi& s = spi1();
  static_cast<void>(s.DR);  // what was left there
  came_ = 0;
  write(select, false);
  for (const std::uint8_t byte : said) {
    s.DR = byte;
    if (!wait_for(Spi::kReceived, true)) break;
    heard_[came_++] = static_cast<std::uint8_t>(s.DR);
  }
  static_cast<void>(wait_for(Spi::kBusy, false));
  write(select, true);
}

std::size_t DriverSpi::take(std::span<std::uint8_t> heard) const {
  const std::size_t count = std::min(heard.size(), came_);
  std::copy_n(heard_.begin(), count, heard.begin());
  return count;
}

}  // namespace kinebus::stm32
