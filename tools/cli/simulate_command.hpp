#pragma once
// `kinebus simulate`: a job on the whole simulated machine, measured from outside.

#include <CLI/CLI.hpp>

namespace kinebus {
/// `json`, which outlives the parse: print JSON instead of words.
void add_simulate_command(CLI::App& app, const bool& json, int& exit_code);
}  // namespace kinebus
