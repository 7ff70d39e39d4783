#pragma once
// Step and direction pins of the extruder's driver. TIM1 counts microseconds; its compare event 1 asks DMA1's
// channel 1 for a word, which it writes to port D's BSRR, round and round two frames. No instruction takes
// part in an edge.

#include <array>
#include <cstdint>

#include "node_firmware/board/step_motors.hpp"
#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/clock_tree.hpp"
#include "node_firmware/port/stm32g0b1_ebb/pins.hpp"

namespace kinebus::g0b1 {

class StepPort {
 public:
  static constexpr std::size_t kPorts = 1;
  static constexpr int kStepBits = ebb::kStepBits;
  /// A pass of the main loop may take 5.6 ms.
  static constexpr PlanSize kPlan{.pieces = MotionPlan::kPieces, .fresh = 5, .axes = 1};
  /// Axis B is not there.
  static constexpr std::array<StepPins, kAxesPerNode> kPins{
      {{0, 0, bit(ebb::kStep.number), bit(ebb::kDirection.number)}, {}}};
  static_assert(ebb::kStep.port == stm32::Port::D && ebb::kDirection.port == stm32::Port::D);

  PlanCounts start(const step::StepFrames<kPorts>& frames);
  static PlanCounts counts() { return local_counts(); }
  static void acknowledge_control() { dma1().IFCR = Dma::kAllOfChannel1; }
  static void enable(int axis, bool on) {
    if (axis == 0) write(ebb::kEnable, !on);
  }
};
static_assert(StepStage<StepPort>);

}  // namespace kinebus::g0b1
