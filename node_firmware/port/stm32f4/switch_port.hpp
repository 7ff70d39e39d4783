#pragma once
// The switch inputs of a board: edges by EXTI, with the local time of the interrupt.

#include "node_firmware/board/drivers.hpp"
#include "node_firmware/board/ring.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"

namespace kinebus::stm32 {

/// The interrupt of an EXTI line.
constexpr Irq exti_irq(unsigned line) {
  if (line < 5) return static_cast<Irq>(static_cast<int>(Irq::kExti0) + static_cast<int>(line));
  return line < 10 ? Irq::kExti9To5 : Irq::kExti15To10;
}

template <const auto& kPins>
class SwitchPort {
 public:
  /// After this the level of every input waits as if it had just come.
  void start(std::uint32_t counts) {
    enable_clock(rcc().APB2ENR, Rcc::kSysConfig);
    std::uint32_t lines = 0;
    for (const SwitchPin& pin : kPins) {
      Reg& select = sysconfig().EXTICR[pin.line / 4];
      const unsigned at = (pin.line % 4u) * 4;
      select = (select & ~(0xFu << at)) | static_cast<std::uint32_t>(pin.port) << at;
      lines |= bit(pin.line);
    }
    exti().RTSR = lines;
    exti().FTSR = lines;
    exti().IMR = lines;
    for (std::size_t i = 0; i < kPins.size(); ++i)
      edges_.push({counts, static_cast<std::uint8_t>(i), read(kPins[i])});
    for (const SwitchPin& pin : kPins) enable_interrupt(exti_irq(pin.line), 1);
  }

  static bool read_level(std::size_t input) { return read(kPins[input]); }
  const SwitchEdge* front() const { return edges_.front(); }
  void drop() { edges_.drop(); }

  /// Interrupt. A switch that chatters faster than 64 edges in a pass of the main loop loses some: their last
  /// level is what read_level() says.
  void on_edges(std::uint32_t counts) {
    const std::uint32_t pending = exti().PR;
    exti().PR = pending;
    for (std::size_t i = 0; i < kPins.size(); ++i)
      if ((pending & bit(kPins[i].line)) != 0)
        edges_.push({counts, static_cast<std::uint8_t>(i), read(kPins[i])});
  }

 private:
  Ring<SwitchEdge, 64> edges_;
};
}  // namespace kinebus::stm32
