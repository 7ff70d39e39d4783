#pragma once
// The board's motor, its plan and its driver, which the main loop and the control interrupt share.

#include <optional>

#include "node_firmware/board/step_motors.hpp"
#include "node_firmware/port/stm32g0b1_ebb/driver_uart.hpp"
#include "node_firmware/port/stm32g0b1_ebb/step_stage.hpp"
#include "node_firmware/step/soldered_driver.hpp"

namespace kinebus::g0b1 {

using Drivers = step::DriverChain<DriverUart, 1, step::SolderedDriver>;

struct MotorParts {
  StepMotors<StepPort, Drivers>::Plans plans;
  DriverUart wire;
  Drivers drivers{wire};
  StepMotors<StepPort, Drivers> motors{plans, drivers};
};
/// Made by main() first of all. Were it there from the start, its zeros would take 2 KiB of flash.
inline constinit std::optional<MotorParts> motor_parts;

}  // namespace kinebus::g0b1
