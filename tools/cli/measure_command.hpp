#pragma once
// `kinebus measure`: what the encoders say, kept for kinebus-calibrate.

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/cli/machine_commands.hpp"

namespace kinebus {
void add_measure_command(CLI::App& app, const std::shared_ptr<MachineOptions>& options);
}  // namespace kinebus
