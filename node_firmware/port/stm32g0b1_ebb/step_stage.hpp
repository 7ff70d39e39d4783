#pragma once
// Step and direction pins of the extruder's driver: the outputs of TIM16 and TIM17, for DMA does not reach
// this chip's ports. TIM1 counts microseconds; its compare events 1 and 2 ask DMA1's channels 1 and 3 for a
// word each, which forces the output high or low or leaves it (CCMR1), round and round two frames. No
// instruction takes part in an edge.

#include <array>
#include <cstdint>

#include "node_firmware/board/step_motors.hpp"
#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/clock_tree.hpp"
#include "node_firmware/port/stm32g0b1_ebb/pins.hpp"

namespace kinebus::g0b1 {

class StepPort {
 public:
  static constexpr std::size_t kPorts = 2;  ///< steps, directions
  using Frames = step::StepFrames<kPorts, step::ForcedWords>;
  static constexpr int kStepBits = ebb::kStepBits;
  static constexpr bool kQuickDivision = false;
  /// A pass of the main loop may take 5.6 ms.
  static constexpr PlanSize kPlan{.pieces = MotionPlan::kPieces, .fresh = 5, .axes = 1};
  /// Axis B is not there.
  static constexpr std::array<StepPins, kAxesPerNode> kPins{
      {{0, 1, step::ForcedWords::kChannel1, step::ForcedWords::kChannel1}, {}}};

  PlanCounts start(const Frames& frames);
  static PlanCounts counts() { return local_counts(); }
  static void acknowledge_control() { dma1().IFCR = Dma::all_of(0); }
  static void enable(int axis, bool on) {
    if (axis == 0) write(ebb::kEnable, !on);
  }
};
static_assert(StepStage<StepPort>);

}  // namespace kinebus::g0b1
