#pragma once
// The CLI's commands about jobs and the machine file on the gateway.

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/cli/machine_commands.hpp"

namespace kinebus {

/// Adds run, watch, upload, jobs, delete, check, history, events, machine-file to `app`.
void add_job_commands(CLI::App& app, const std::shared_ptr<MachineOptions>& options, int& exit_code);

}  // namespace kinebus
