#pragma once
// The seven switch inputs: edges by EXTI, with the local time of the interrupt.

#include "node_firmware/board/drivers.hpp"
#include "node_firmware/board/ring.hpp"
#include "node_firmware/port/stm32f405/pins.hpp"

namespace kinebus::stm32 {

class SwitchPort {
 public:
  /// After this the level of every input waits as if it had just come.
  void start(std::uint32_t counts) {
    enable_clock(rcc().APB2ENR, Rcc::kSysConfig);
    std::uint32_t lines = 0;
    for (const board::SwitchPin& pin : board::kSwitchPins) {
      Reg& select = sysconfig().EXTICR[pin.line / 4];
      const unsigned at = (pin.line % 4u) * 4;
      select = (select & ~(0xFu << at)) | static_cast<std::uint32_t>(pin.port) << at;
      lines |= bit(pin.line);
    }
    exti().RTSR = lines;
    exti().FTSR = lines;
    exti().IMR = lines;
    for (std::size_t i = 0; i < board::kSwitchPins.size(); ++i)
      edges_.push({counts, static_cast<std::uint8_t>(i), read(board::kSwitchPins[i])});
    for (const Irq irq :
         {Irq::kExti0, Irq::kExti1, Irq::kExti3, Irq::kExti4, Irq::kExti9To5, Irq::kExti15To10})
      enable_interrupt(irq, 1);
  }

  static bool read_level(std::size_t input) { return read(board::kSwitchPins[input]); }
  const SwitchEdge* front() const { return edges_.front(); }
  void drop() { edges_.drop(); }

  /// Interrupt. A switch that chatters faster than 64 edges in a pass of the main loop loses some: their last
  /// level is what read_level() says.
  void on_edges(std::uint32_t counts) {
    const std::uint32_t pending = exti().PR;
    exti().PR = pending;
    for (std::size_t i = 0; i < board::kSwitchPins.size(); ++i)
      if ((pending & bit(board::kSwitchPins[i].line)) != 0)
        edges_.push({counts, static_cast<std::uint8_t>(i), read(board::kSwitchPins[i])});
  }

 private:
  Ring<SwitchEdge, 64> edges_;
};
static_assert(SwitchDriver<SwitchPort>);

}  // namespace kinebus::stm32
