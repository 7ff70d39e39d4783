#pragma once
// `kinebus plan`: the user's estimate and pre-flight, without any machine.

#include <CLI/CLI.hpp>

namespace kinebus {
void add_plan_command(CLI::App& app, int& exit_code);
}  // namespace kinebus
