#pragma once
// One frame of an absolute scale on an encoder port: clock and data, no select (SSI).

#include <cstdint>
#include <optional>

#include "node_firmware/port/stm32f4/registers.hpp"

namespace kinebus::stm32 {

class SsiReader {
 public:
  explicit SsiReader(int axis) : spi_(axis == 0 ? spi1() : spi3()), axis_(axis) {}

  /// The clock rests high; the scale puts a bit out with each rising edge, and with each falling one it is
  /// taken.
  void start() {
    // 84 MHz / 128, 42 MHz / 64: 656 kHz, for long cables.
    spi_.CR1 = Spi::kRestsHigh | Spi::kMaster | Spi::kInternalSelect | Spi::kSoftwareSelect | Spi::kFrame16 |
               Spi::divide(axis_ == 0 ? 7 : 6) | Spi::kEnable;
  }

  /// 32 clocks, 49 us. None: an interrupt was so long that a half was lost.
  std::optional<std::uint32_t> read() {
    static_cast<void>(spi_.DR);
    static_cast<void>(spi_.SR);
    // A clock that rests between the halves would be the frame's end to the scale.
    disable_interrupts();
    spi_.DR = kNothing;
    const bool taken = wait_for(Spi::kSendEmpty);
    spi_.DR = kNothing;
    enable_interrupts();
    if (!taken || !wait_for(Spi::kReceived)) return std::nullopt;
    // The flag: the second half came before the first one was read, and is gone.
    const bool lost = (spi_.SR & Spi::kOverrun) != 0;
    const std::uint32_t first = spi_.DR;
    if (lost || !wait_for(Spi::kReceived)) return std::nullopt;
    const std::uint32_t second = spi_.DR;
    return first << 16 | (second & 0xFFFF);
  }

 private:
  static constexpr std::uint32_t kNothing = 0xFFFF;

  /// A half takes 24 us, 4100 cycles of the core.
  bool wait_for(std::uint32_t flag) const {
    for (int i = 0; i < 10'000; ++i)
      if ((spi_.SR & flag) != 0) return true;
    return false;
  }

  Spi& spi_;
  int axis_;
};

}  // namespace kinebus::stm32
