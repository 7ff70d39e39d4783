#pragma once
// `kinebus explain`: a flight recorder's report in plain words.

#include <CLI/CLI.hpp>

namespace kinebus {
void add_explain_command(CLI::App& app, int& exit_code);
}  // namespace kinebus
