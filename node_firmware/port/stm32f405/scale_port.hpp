#pragma once
// Scales on the carriages: quadrature, counted by timers, or absolute, read by SSI on the encoder port. On as
// soon as the master says that one is fitted (2160h:1), and their pins what they were when it says that none
// is.

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

#include "node_firmware/board/absolute_scale.hpp"
#include "node_firmware/core/node.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"
#include "node_firmware/port/stm32f405/board.hpp"
#include "node_firmware/port/stm32f405/power_stage.hpp"
#include "node_firmware/port/stm32f405/ssi_reader.hpp"

namespace kinebus::stm32 {

class ScalePort {
 public:
  /// Main loop, each pass, before the node is given its inputs: a timer has 16 bits, of which half are gone
  /// through in 0.7 s at 450 mm/s and 0.01 mm. What an edge of a switch is seen with is a pass younger at
  /// most, or kReading: at the slow speed of homing less than a count.
  void serve(Node& node) {
    const std::uint32_t counts = local_counts();
    now_ += std::chrono::nanoseconds{std::int64_t{kLocalNs} * (counts - counts_)};
    counts_ = counts;
    for (int axis = 0; axis < 2; ++axis) {
      Scale& scale = scales_[static_cast<std::size_t>(axis)];
      if (const Node::Scale fitted = node.scale(axis); fitted != scale.fitted) change(axis, fitted);
      if (scale.absolute)
        serve_absolute(axis, node);
      else if (scale.fitted.quadrature())
        serve_counter(axis, node);
    }
  }

 private:
  /// Between two readings of an absolute scale, which hold the loop up for 49 us: longer than any is away
  /// behind a frame.
  static constexpr LocalTime kReading = std::chrono::milliseconds{1};

  struct Scale {
    Node::Scale fitted{};
    std::uint32_t total = 0;  ///< of the counter
    std::uint16_t last = 0;
    std::optional<AbsoluteScale> absolute{};
    LocalTime asked{0};
  };

  void serve_counter(int axis, Node& node) {
    Scale& scale = scales_[static_cast<std::size_t>(axis)];
    const auto count = static_cast<std::uint16_t>(timer(axis).CNT);
    scale.total +=
        static_cast<std::uint32_t>(static_cast<std::int32_t>(static_cast<std::int16_t>(count - scale.last)));
    scale.last = count;
    node.set_scale(axis, static_cast<std::int32_t>(scale.total));
  }
  void serve_absolute(int axis, Node& node) {
    Scale& scale = scales_[static_cast<std::size_t>(axis)];
    if (now_ - scale.asked < kReading) return;
    scale.asked = now_;
    if (const auto frame = SsiReader(axis).read()) scale.absolute->take(now_, *frame);
    if (scale.absolute->silent(now_))
      node.lose_scale(axis);
    else
      node.set_scale(axis, scale.absolute->counts());
  }
  void change(int axis, const Node::Scale& fitted) {
    Scale& scale = scales_[static_cast<std::size_t>(axis)];
    const bool counter = fitted.quadrature();
    if (scale.fitted.quadrature() && !counter) stop(axis);
    if (scale.absolute && !fitted.absolute()) PowerStage::return_encoder_port(axis);
    if (!scale.absolute && fitted.absolute()) PowerStage::lend_encoder_port(axis), SsiReader(axis).start();
    scale.absolute.reset();
    if (fitted.absolute())
      scale.absolute.emplace(AbsoluteScale::Settings{
          .bits = fitted.bits(), .gray = fitted.gray(), .counts_per_m = fitted.counts_per_m});
    if (counter && !scale.fitted.quadrature()) start(axis);
    scale.fitted = fitted;
  }

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
  std::uint32_t counts_ = 0;
  LocalTime now_{0};
};

}  // namespace kinebus::stm32
