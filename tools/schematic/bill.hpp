#pragma once
// What to order.

#include <string>

#include "tools/schematic/netlist.hpp"

namespace kinebus::schematic {

/// As CSV: one line a part number, in order of its first reference.
std::string bill_of_materials(const Netlist& netlist);

}  // namespace kinebus::schematic
