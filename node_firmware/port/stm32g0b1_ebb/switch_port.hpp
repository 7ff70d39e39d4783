#pragma once
// The switch inputs: edges by EXTI, with the local time of the interrupt.

#include "node_firmware/board/drivers.hpp"
#include "node_firmware/board/ring.hpp"
#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/pins.hpp"

namespace kinebus::g0b1 {

constexpr Irq exti_irq(unsigned line) {
  if (line < 2) return Irq::kExti0To1;
  return line < 4 ? Irq::kExti2To3 : Irq::kExti4To15;
}

class SwitchPort {
 public:
  /// After this the level of every input waits as if it had just come.
  void start(std::uint32_t counts) {
    std::uint32_t lines = 0;
    for (const stm32::SwitchPin& pin : ebb::kSwitchPins) {
      Reg& select = exti().EXTICR[pin.line / 4];
      const unsigned at = (pin.line % 4u) * 8;
      select = (select & ~(0xFFu << at)) | static_cast<std::uint32_t>(pin.port) << at;
      lines |= bit(pin.line);
    }
    exti().RTSR1 = lines;
    exti().FTSR1 = lines;
    exti().IMR1 = lines;
    for (std::size_t i = 0; i < ebb::kSwitchPins.size(); ++i)
      edges_.push({counts, static_cast<std::uint8_t>(i), read(ebb::kSwitchPins[i])});
    for (const stm32::SwitchPin& pin : ebb::kSwitchPins) enable_interrupt(exti_irq(pin.line), 1);
  }
  const SwitchEdge* front() const { return edges_.front(); }
  void drop() { edges_.drop(); }

  /// Interrupt. A switch that chatters faster than 64 edges in a pass of the main loop loses some.
  void on_edges(std::uint32_t counts) {
    const std::uint32_t pending = exti().RPR1 | exti().FPR1;
    exti().RPR1 = pending;
    exti().FPR1 = pending;
    for (std::size_t i = 0; i < ebb::kSwitchPins.size(); ++i)
      if ((pending & bit(ebb::kSwitchPins[i].line)) != 0)
        edges_.push({counts, static_cast<std::uint8_t>(i), read(ebb::kSwitchPins[i])});
  }

 private:
  Ring<SwitchEdge, 64> edges_;
};
static_assert(SwitchDriver<SwitchPort>);

}  // namespace kinebus::g0b1
