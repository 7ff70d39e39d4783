#pragma once
// What is wrong with any schematic, whatever it is for.

#include <string>
#include <vector>

#include "tools/schematic/netlist.hpp"

namespace kinebus::schematic {

/// Pins that are on nothing and not marked so, marks on connected pins, outputs against outputs, supply pins
/// that nothing feeds, inputs that nothing drives, parts that nobody can order; and the netlist's own
/// complaints. One line each.
std::vector<std::string> check_rules(const Netlist& netlist);

}  // namespace kinebus::schematic
