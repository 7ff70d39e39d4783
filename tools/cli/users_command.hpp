#pragma once
// `kinebus users`: who may ask the gateway by HTTP, in the file that kinebusd reads.

#include <CLI/CLI.hpp>

namespace kinebus {
/// `json`: print JSON instead of words.
void add_users_command(CLI::App& app, const bool& json);
}  // namespace kinebus
