// The control interrupt: apart from the main loop, because here time counts, there room.

#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32g0b1_ebb/motors.hpp"

extern "C" void isr_control() {
  kinebus::g0b1::motor_parts->motors.on_control();
}
