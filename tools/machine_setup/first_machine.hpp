#pragma once
// The first machine file of a machine: limits and geometry as in the shipped file of its kind, everything
// that is connected where the boards have it.

#include <string>

#include "gateway/description/machine_description.hpp"
#include "tools/machine_setup/board_set.hpp"

namespace kinebus {

struct FirstMachine {
  SetupMachine machine = SetupMachine::kM1;
  BoardSet boards = BoardSet::kOctopus;
  std::uint8_t heat_node = 0;  ///< as plan_boards()
  SensorWiring hotend_sensor{}, bed_sensor{};
  int mains_hz = 50;
  bool probe = false;
  std::string interface = "can0";
};

/// How many joints it has.
std::size_t joints_of(SetupMachine machine);
BoardPlan plan_of(const FirstMachine& first);
/// Post-condition: parse_machine() takes it.
MachineDescription make_description(const FirstMachine& first);
/// The description, which may have been changed since, as a file with comments. Post-condition:
/// parse_machine() of it gives `description`.
std::string file_text(const FirstMachine& first, const MachineDescription& description);

/// [node.N.inputN] of every joint's switch as its node, axis and homing say; polarity and debouncing of
/// inputs that are used already stay.
void connect_switches(MachineDescription& description);

}  // namespace kinebus
