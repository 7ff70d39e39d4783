#pragma once
// `kinebus gcode`: the reference of all codes, from the interpreter's own table.

#include <CLI/CLI.hpp>

namespace kinebus {
void add_gcode_command(CLI::App& app, int& exit_code);
}  // namespace kinebus
