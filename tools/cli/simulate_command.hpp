#pragma once
// `kinebus simulate`: a job on the whole simulated machine, measured from outside.

#include <CLI/CLI.hpp>

namespace kinebus {
void add_simulate_command(CLI::App& app, int& exit_code);
}  // namespace kinebus
