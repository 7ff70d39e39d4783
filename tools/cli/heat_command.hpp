#pragma once
// kinebus heat: a heater's target by hand, and waiting for it.

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/cli/machine_commands.hpp"

namespace kinebus {

void add_heat(CLI::App& app, const std::shared_ptr<MachineOptions>& options, int& exit_code);

}  // namespace kinebus
