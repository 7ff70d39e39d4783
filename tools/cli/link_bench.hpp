#pragma once
// `kinebus bench`: how fast the link to the daemon is.

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/cli/machine_commands.hpp"

namespace kinebus {
void add_link_bench(CLI::App& app, const std::shared_ptr<MachineOptions>& options);
}  // namespace kinebus
