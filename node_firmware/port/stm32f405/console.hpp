#pragma once
// The console: one letter asks, a few lines answer. For diagnosis without a bus. One interpreter for every
// line that leads to it; USART1 and USB have one each.

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "node_firmware/port/stm32f405/can_port.hpp"
#include "node_firmware/port/stm32f405/motor_port.hpp"

namespace kinebus::stm32 {

class Console {
 public:
  /// What it tells of.
  struct Subject {
    const Node& node;
    const MotorPort& motors;
    const CanPort& can;
  };
  /// Only when nothing is waiting: who does not read is not heard.
  void hear(char letter, const Subject& subject);
  /// The answer, as far as it is not sent.
  std::span<const char> waiting() const { return std::span(text_).subspan(sent_, length_ - sent_); }
  void sent(std::size_t count);
  void forget();
  /// "DFU" was said while no axis had power: the chip's own boot loader is to take over.
  bool system_boot_requested() const { return system_boot_requested_; }

 private:
  Console& put(std::string_view text);
  Console& put(std::int64_t number);
  void answer(char letter, const Subject& subject);
  void axis(int axis, const Subject& subject);
  void request_system_boot(const Node& node);

  std::array<char, 512> text_{};
  std::size_t length_ = 0, sent_ = 0, matched_ = 0;
  bool system_boot_requested_ = false;
};

}  // namespace kinebus::stm32
