#pragma once
// `kinebus plan`: the user's estimate and pre-flight, without any machine.

#include <CLI/CLI.hpp>

namespace kinebus {
/// `json`, which outlives the parse: print JSON instead of words.
void add_plan_command(CLI::App& app, const bool& json, int& exit_code);
}  // namespace kinebus
