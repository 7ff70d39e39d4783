#include "tools/cli/heat_command.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "tools/cli/job_watch.hpp"
#include "tools/cli/requests.hpp"

namespace kinebus {
namespace {

/// Of that name in the machine file. Throws: there is none, and which there are.
joblink::HeaterInfo heater_called(Client& client, const std::string& name) {
  const joblink::MachineInfo machine =
      client.ask(plain(&joblink::ClientMessage::mutable_get_machine)).machine();
  std::string all;
  for (const joblink::HeaterInfo& heater : machine.heaters()) {
    if (heater.name() == name) return heater;
    all += (all.empty() ? "" : ", ") + heater.name();
  }
  if (all.empty()) throw ClientError("this machine has no heaters");
  throw ClientError(fmt::format("this machine has no heater {}: it has {}", name, all));
}

}  // namespace

void add_heat(CLI::App& app, const std::shared_ptr<MachineOptions>& options, int& exit_code) {
  auto* heat = app.add_subcommand("heat", "Set a heater's target: kinebus heat hotend 210 --wait");
  auto name = std::make_shared<std::string>();
  auto celsius = std::make_shared<double>(0);
  auto wait = std::make_shared<bool>(false);
  heat->add_option("heater", *name, "Its name in the machine file: hotend, bed")->required();
  heat->add_option("celsius", *celsius, "0: off")->required()->check(CLI::Range(0.0, 1000.0));
  heat->add_flag("--wait", *wait, "Return when it is there instead of at once");
  heat->callback([=, &exit_code] {
    const bool watch = *wait && *celsius > 0;
    Client client(options->reach, watch ? 5 : 0, watch);
    const joblink::HeaterInfo heater = heater_called(client, *name);
    take_control(client, *options);
    joblink::ClientMessage request;
    request.mutable_set_temperature()->set_kind(heater.kind());
    request.mutable_set_temperature()->set_index(heater.index());
    request.mutable_set_temperature()->set_celsius(*celsius);
    client.ask(std::move(request));
    if (!watch) return;
    // It heats without this program: whoever wants to switch it off may do so.
    client.release_control();
    exit_code = wait_for_heat(client, *name, *celsius);
  });
}

}  // namespace kinebus
