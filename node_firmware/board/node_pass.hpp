#pragma once
// What the main loop of every board does for its node in a pass, whatever drives the motors.

#include "node_firmware/board/node_program.hpp"
#include "node_firmware/board/upkeep.hpp"

namespace kinebus {

/// `motors_good`: they may get power; where they are not, an axis that is switched on goes to fault.
template <typename Program, typename Motors, WatchdogDriver Watchdog>
void pass(Program& program, Motors& motors, bool motors_good, PageStore& parameters, Watchdog& dog) {
  program.pass();
  // A stop for a drive's sake is named from this very moment, and told before anything else is done.
  if (motors_good ? motors.serve(program.node(), program.read_time()) : program.refuse_power()) {
    program.send();
    program.touch();
  }
  if (motors.dark()) store_parameters(program.node(), parameters, dog);
}

}  // namespace kinebus
