#pragma once

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/cli/machine_commands.hpp"

namespace kinebus {

/// tune vibration, tune pressure: below `tune`
void add_tune_commands(CLI::App& tune, const std::shared_ptr<MachineOptions>& options, int& exit_code);

}  // namespace kinebus
