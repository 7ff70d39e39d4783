#pragma once
// The board's motor, which the main loop and the control interrupt share.

#include "node_firmware/board/step_motors.hpp"
#include "node_firmware/port/stm32g0b1_ebb/step_stage.hpp"

namespace kinebus::g0b1 {

using Motors = StepMotors<StepPort>;
inline constinit Motors::Plans plans;
inline constinit Motors motors{plans};

}  // namespace kinebus::g0b1
