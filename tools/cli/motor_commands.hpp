#pragma once

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/cli/machine_commands.hpp"

namespace kinebus {

/// current, tune, jog-motor
void add_motor_commands(CLI::App& app, const std::shared_ptr<MachineOptions>& options, int& exit_code);

}  // namespace kinebus
