#pragma once
// kinebus heat: a heater's target by hand, and waiting for it. And what kinebus tune does with a heater.

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "tools/cli/machine_commands.hpp"

namespace kinebus {

void add_heat(CLI::App& app, const std::shared_ptr<MachineOptions>& options, int& exit_code);

/// Of that name in the machine file; nullptr: there is none.
const joblink::HeaterInfo* heater_called(const joblink::MachineInfo& machine, const std::string& name);
/// That there is none, and which there are.
std::string no_such_heater(const joblink::MachineInfo& machine, const std::string& name);
/// Lets its node measure it, shows how it goes and what came out. `celsius` 0: the gateway chooses. Returns
/// the exit code. The client must be watching.
int tune_heater(Client& client, const MachineOptions& options, const joblink::HeaterInfo& heater,
                double celsius);

}  // namespace kinebus
