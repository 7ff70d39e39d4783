#pragma once
// The CLI's commands to a running daemon.

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/cli/client.hpp"

namespace kinebus {

struct MachineOptions {
  Reach reach;
  bool json = false;   ///< print JSON instead of words
  bool force = false;  ///< take control from another client
};

/// From whoever has it, when the options say so.
void take_control(Client& client, const MachineOptions& options);

/// Adds status, position, nodes, bus, bring-up, home, reference, jog, hold, resume, cancel, stop, clear,
/// motors-off, heat, override, console, clients to `app`; each sets `exit_code` when it runs.
void add_machine_commands(CLI::App& app, const std::shared_ptr<MachineOptions>& options, int& exit_code);

}  // namespace kinebus
