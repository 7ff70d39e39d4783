#pragma once
// What the main loop of every board does for its nodes in a pass, whatever drives the motors.

#include "node_firmware/board/node_program.hpp"
#include "node_firmware/board/upkeep.hpp"

namespace kinebus {

/// No motor may have power: an axis that is switched on has a fault, whose code says why. True: so it was.
inline bool refuse_power(Node& node, LocalTime now, std::uint16_t reason) {
  bool refused = false;
  for (int axis = 0; axis < kAxesPerNode; ++axis) {
    if (!node.drive(axis).power) continue;
    node.on_drive_fault(now, axis, reason);
    refused = true;
  }
  return refused;
}

/// `refusal`: why no motor may get power, an EMCY code; kNoError: they may. `save(number, image)`: into
/// flash; false: it did not work.
template <typename Program, typename Motors, typename Save, WatchdogDriver Watchdog>
void pass(Program& program, Motors& motors, std::uint16_t refusal, Save&& save, Watchdog& dog) {
  program.pass();
  const auto serve = [&](std::size_t number, Node& node) {
    // A stop for a drive's sake is named from this very moment, and told before anything else is done.
    const LocalTime now = program.read_time();
    if (refusal != emcy::kNoError) return refuse_power(node, now, refusal);
    if constexpr (requires { motors.serve(number, node, now); })
      return motors.serve(number, node, now);
    else
      return motors.serve(node, now);
  };
  program.tell_each(serve);
  if (!motors.dark()) return;
  program.tell_each([&](std::size_t number, Node& node) {
    return store_parameters(node, dog, [&](auto image) { return save(number, image); });
  });
}

}  // namespace kinebus
