#pragma once
// The console on USART1: one letter asks, a few lines answer. For diagnosis without a bus.

#include <array>
#include <cstddef>
#include <string_view>

#include "node_firmware/port/stm32f405/can_port.hpp"
#include "node_firmware/port/stm32f405/motor_port.hpp"

namespace kinebus::stm32 {

class Console {
 public:
  /// 115200 8N1.
  void start();
  /// Main loop, each pass: takes a letter, gives one on. Never waits.
  void serve(const Node& node, const MotorPort& motors, const CanPort& can);

 private:
  Console& put(std::string_view text);
  Console& put(std::int64_t number);
  void answer(char letter, const Node& node, const MotorPort& motors, const CanPort& can);
  void axis(int axis, const Node& node, const MotorPort& motors);

  std::array<char, 512> text_{};
  std::size_t length_ = 0, sent_ = 0;
};

}  // namespace kinebus::stm32
