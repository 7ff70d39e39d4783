#pragma once
// The CLI's commands to a running daemon.

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace kinebus {

struct MachineOptions {
  std::string socket;
  bool json = false;  ///< print what the daemon said instead of words
};

/// Adds status, home, reference, jog, run, watch, hold, resume, cancel, stop, clear, override, motors-off,
/// position, nodes, bus, jobs, console to `app`; each sets `exit_code` when it runs.
void add_machine_commands(CLI::App& app, const std::shared_ptr<MachineOptions>& options, int& exit_code);

}  // namespace kinebus
