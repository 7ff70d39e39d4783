#pragma once
// Step and direction pins of MOTOR0 and MOTOR1. TIM1 counts microseconds; its compare events 1 and 2 ask DMA2
// for a word each: stream 1 writes those of port F, stream 2 those of port G, round and round two frames of
// each. No instruction takes part in an edge.

#include <array>
#include <cstdint>

#include "node_firmware/board/step_motors.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f446_octopus/board.hpp"

namespace kinebus::stm32 {

class StepPort {
 public:
  static constexpr std::size_t kPorts = 2;
  static constexpr std::array<Port, kPorts> kGpio{Port::F, Port::G};
  static constexpr int kStepBits = octopus::kStepBits;
  static constexpr std::array<StepPins, kAxesPerNode> kPins = [] {
    std::array<StepPins, kAxesPerNode> pins{};
    const auto index = [](Port port) { return static_cast<std::size_t>(port == kGpio[0] ? 0 : 1); };
    for (std::size_t i = 0; i < pins.size(); ++i) {
      const octopus::DriverPins& driver = octopus::kDrivers[i];
      pins[i] = {index(driver.step.port), index(driver.direction.port), bit(driver.step.number),
                 bit(driver.direction.number)};
    }
    return pins;
  }();

  PlanCounts start(const step::StepFrames<kPorts>& frames);
  static std::uint32_t cycles() { return dwt().CYCCNT; }
  static PlanCounts counts() { return local_counts(); }
  static void acknowledge_control() { dma2().LIFCR = Dma::flags(1); }
  static void enable(int axis, bool on) {
    write(octopus::kDrivers[static_cast<std::size_t>(axis)].enable, !on);
  }
};
static_assert(StepStage<StepPort>);

}  // namespace kinebus::stm32
