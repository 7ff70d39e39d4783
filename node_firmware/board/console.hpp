#pragma once
// The console: one letter asks, a few lines answer. For diagnosis without a bus. One interpreter for every
// line that leads to it: a serial port and USB have one each.

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "node_firmware/board/bridge_motors.hpp"
#include "node_firmware/board/drivers.hpp"

namespace kinebus {

class Console {
 public:
  /// What it tells of.
  struct Subject {
    const Node& node;
    const MotorSupervision& motors;
    ControlCycles cycles;
    std::uint32_t control_interrupts = 0;
    const CanEvents& can;
    bool off_the_bus = false;
    bool no_bus = false;    ///< none was found since the start
    bool own_board = true;  ///< else the image is for another one, and drives nothing
    std::uint32_t serial = 0, image_bytes = 0;
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
  template <std::size_t kSize>
  Console& put(const char (&text)[kSize]) {
    return put(std::string_view(text, kSize - 1));
  }
  Console& put(std::int64_t number);
  Console& put_hex(std::uint32_t number);
  void reset(const ResetReport& report);
  void answer(char letter, const Subject& subject);
  void axis(int axis, const Subject& subject);
  void request_system_boot(const Node& node);

  std::array<char, 512> text_{};
  std::size_t length_ = 0, sent_ = 0, matched_ = 0;
  bool system_boot_requested_ = false;
};

}  // namespace kinebus
