#pragma once
// USART1 as a line to the console: a byte a pass, and never a wait.

#include "node_firmware/board/console.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"
#include "node_firmware/port/stm32f405/board.hpp"

namespace kinebus::stm32 {

class UsartPort {
 public:
  /// 115200 8N1.
  void start() {
    constexpr std::uint32_t kBaud = 115'200;
    enable_clock(rcc().APB2ENR, Rcc::kUsart1);
    usart1().BRR = (board::kApb2Hz + kBaud / 2) / kBaud;
    usart1().CR1 = Usart::kEnable | Usart::kTransmitter | Usart::kReceiver;
  }
  /// Main loop, each pass.
  void serve(const Console::Subject& subject) {
    const std::uint32_t status = usart1().SR;
    if (const auto text = console_.waiting(); !text.empty()) {
      if ((status & Usart::kSendEmpty) == 0) return;
      usart1().DR = static_cast<std::uint8_t>(text.front());
      console_.sent(1);
    } else if ((status & Usart::kReceived) != 0) {
      console_.hear(static_cast<char>(usart1().DR & 0x7F), subject);
    }
  }
  const Console& console() const { return console_; }

 private:
  Console console_;
};

}  // namespace kinebus::stm32
