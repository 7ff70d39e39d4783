#include "node_firmware/port/stm32/outputs_off.hpp"

#include "node_firmware/port/stm32f4/backup_port.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f446_octopus/board.hpp"

namespace kinebus::stm32 {

void outputs_off() {
  disable_interrupts();
  for (const octopus::PowerPin& power : octopus::kPowerPins) write(power.pin, power.off);
  write(octopus::kContactorPin, false);
  barrier();
}

void keep_records() {
  backup::save();
}

}  // namespace kinebus::stm32
