#pragma once
// What the machine, its nodes, the bus and its clients are like now: kinebus status and its like.

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/cli/client.hpp"
#include "tools/cli/machine_commands.hpp"

namespace kinebus {

/// The gateway reads currents while somebody looks: its first answer has none yet.
joblink::Status with_currents(Client& client);

/// Adds status, position, nodes, bus and clients to `app`.
void add_views(CLI::App& app, const std::shared_ptr<MachineOptions>& options);

}  // namespace kinebus
