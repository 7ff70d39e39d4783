#pragma once
// Step and direction pins of the eight drivers. TIM1 counts microseconds; at the end of each its compare
// events and its update ask DMA2 for a word for each GPIO port, round and round two frames of each. No
// instruction takes part in an edge.

#include <algorithm>
#include <array>
#include <cstdint>

#include "node_firmware/board/step_motors.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f446_octopus/board.hpp"

namespace kinebus::stm32 {

class StepPort {
 public:
  static constexpr std::size_t kPorts = 5;
  using Frames = step::StepFrames<kPorts>;
  static constexpr std::array<Port, kPorts> kGpio{Port::F, Port::G, Port::C, Port::E, Port::A};
  static constexpr int kStepBits = octopus::kStepBits;
  static constexpr bool kQuickDivision = true;
  static constexpr PlanSize kPlan{.pieces = MotionPlan::kPieces, .fresh = MotionPlan::kPieces / 2};
  static constexpr auto kPins = [] {
    std::array<StepPins, octopus::kDrivers.size()> pins{};
    const auto index = [](Port port) {
      return static_cast<std::size_t>(std::find(kGpio.begin(), kGpio.end(), port) - kGpio.begin());
    };
    for (std::size_t i = 0; i < pins.size(); ++i) {
      const octopus::DriverPins& driver = octopus::kDrivers[i];
      pins[i] = {index(driver.step.port), index(driver.direction.port), bit(driver.step.number),
                 bit(driver.direction.number)};
    }
    return pins;
  }();
  static_assert(std::ranges::all_of(kPins, [](const StepPins& p) {
    return p.step_port < kPorts && p.direction_port < kPorts;
  }));

  PlanCounts start(const Frames& frames);
  static PlanCounts counts() { return local_counts(); }
  static void acknowledge_control() { dma2().clear(1); }
  static void enable(int axis, bool on) {
    write(octopus::kDrivers[static_cast<std::size_t>(axis)].enable, !on);
  }
};
static_assert(StepStage<StepPort>);

}  // namespace kinebus::stm32
