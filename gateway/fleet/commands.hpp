#pragma once

namespace CLI {
class App;
}

namespace kinebus::fleet {

/// init, add, jobs, machines, cancel, release, agent, serve, demo. What goes wrong is thrown.
void add_commands(CLI::App& app);

}  // namespace kinebus::fleet
