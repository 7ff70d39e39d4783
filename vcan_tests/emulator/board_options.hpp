#pragma once
// What hangs on an emulated board, and where its carriages stand.

#include <array>
#include <cstdint>

#include "tools/simulation/bus/virtual_machine.hpp"
#include "vcan_tests/emulator/peripherals/ssi_scale.hpp"
#include "vcan_tests/emulator/physics/power_stage.hpp"
#include "vcan_tests/emulator/physics/stepper_motor.hpp"

namespace kinebus::emulator {

struct BoardOptions {
  std::array<std::uint32_t, 3> unique_id{};
  std::array<StepperParameters, 2> motors{};  ///< of boards that drive motors themselves
  PowerStageParameters stage{};
  /// Where the carriages stand, and their switches: inputs of the board, from 1 on.
  std::array<VirtualAxis, 8> axes{};
  /// On encoder ports, in the place of the encoder: they tell where axes' `scale` is, from their own zero on.
  std::array<SsiScale::Options, 2> absolute_scales{};
  std::array<double, 2> encoder_offset_turns{};  ///< how the magnet is glued on
  std::uint32_t crystal_hz = 0;                  ///< 0: the board's own
  bool measures_crystal = true;                  ///< false: no edge of it comes to TIM11
  double supply_v = 24;
  double temperature_c = 30;
};

}  // namespace kinebus::emulator
