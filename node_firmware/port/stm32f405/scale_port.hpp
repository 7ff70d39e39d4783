#pragma once
// Quadrature scales on the carriages, counted by timers: on as soon as the master says that one is fitted
// (2160h:1), and their pins what they were when it says that none is.

#include <array>
#include <cstdint>

#include "node_firmware/core/node.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"
#include "node_firmware/port/stm32f405/board.hpp"

namespace kinebus::stm32 {

class ScalePort {
 public:
  /// Main loop, each pass, before the node is given its inputs: a timer has 16 bits, of which half are gone
  /// through in 0.7 s at 450 mm/s and 0.01 mm. What an edge of a switch is seen with is a pass younger at
  /// most: at the slow speed of homing less than a count.
  void serve(Node& node) {
    for (int axis = 0; axis < 2; ++axis) {
      Scale& scale = scales_[static_cast<std::size_t>(axis)];
      const bool fitted = node.scale_fitted(axis);
      if (fitted != scale.on) fitted ? start(axis) : stop(axis);
      scale.on = fitted;
      if (!fitted) continue;
      const auto count = static_cast<std::uint16_t>(timer(axis).CNT);
      scale.total += static_cast<std::uint32_t>(
          static_cast<std::int32_t>(static_cast<std::int16_t>(count - scale.last)));
      scale.last = count;
      node.set_scale(axis, static_cast<std::int32_t>(scale.total));
    }
  }

 private:
  struct Scale {
    std::uint32_t total = 0;
    std::uint16_t last = 0;
    bool on = false;
  };

  static Timer& timer(int axis) { return axis == 0 ? tim3() : tim4(); }
  static void choose_pins(int axis, bool scale) {
    const board::ScalePins& pins = board::kScalePins[static_cast<std::size_t>(axis)];
    Gpio& g = gpio(static_cast<unsigned>(pins.port));
    for (const unsigned pin : {unsigned{pins.first}, unsigned{pins.second}}) {
      const auto set = [pin](Reg& reg, unsigned bits, std::uint32_t value) {
        const unsigned at = (pin * bits) % 32;
        reg = (reg & ~(((std::uint32_t{1} << bits) - 1) << at)) | value << at;
      };
      set(g.AFR[pin / 8], 4, scale ? pins.timer : pins.usual);
      // A scale with open collectors counts too, and a cable that is off holds its level.
      if (scale) set(g.PUPDR, 2, static_cast<std::uint32_t>(board::kUp));
      if (!scale) set(g.PUPDR, 2, usual_pull(pins.port, pin));
    }
  }
  static std::uint32_t usual_pull(board::Port port, unsigned number) {
    for (const board::Pin& pin : board::kPins)
      if (pin.port == port && pin.number == number) return static_cast<std::uint32_t>(pin.pull);
    return 0;
  }
  void start(int axis) {
    enable_clock(rcc().APB1ENR, axis == 0 ? Rcc::kTim3 : Rcc::kTim4);
    choose_pins(axis, true);
    Timer& t = timer(axis);
    t.ARR = 0xFFFF;
    t.CCMR1 = Timer::kInputsFiltered;
    t.CCER = 0;
    t.SMCR = Timer::kBothEdges;
    t.CR1 = Timer::kEnable;
    scales_[static_cast<std::size_t>(axis)].last = static_cast<std::uint16_t>(t.CNT);
  }
  void stop(int axis) {
    timer(axis).CR1 = 0;
    choose_pins(axis, false);
  }

  std::array<Scale, 2> scales_{};
};

}  // namespace kinebus::stm32
