#include "tools/cli/heat_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "tools/cli/job_watch.hpp"
#include "tools/cli/requests.hpp"

namespace kinebus {
namespace {

void print_measured(const joblink::Heater& heater) {
  const joblink::HeaterTuning& t = heater.tuning();
  fmt::print("power      {:8.1f} W    (the machine file's)\n", t.power_w());
  fmt::print("capacity   {:8.1f} J/K\n", t.capacity_j_per_k());
  fmt::print("loss       {:8.3f} W/K\n", t.loss_w_per_k());
  fmt::print("dead time  {:8.2f} s\n", t.dead_s());
  fmt::print("lag        {:8.2f} s\n", t.lag_s());
}

}  // namespace

const joblink::HeaterInfo* heater_called(const joblink::MachineInfo& machine, const std::string& name) {
  const auto& heaters = machine.heaters();
  const auto found = std::find_if(heaters.begin(), heaters.end(),
                                  [&](const joblink::HeaterInfo& heater) { return heater.name() == name; });
  return found != heaters.end() ? &*found : nullptr;
}

std::string no_such_heater(const joblink::MachineInfo& machine, const std::string& name) {
  std::string all;
  for (const joblink::HeaterInfo& heater : machine.heaters())
    all += (all.empty() ? "" : ", ") + heater.name();
  if (all.empty()) return "this machine has no heaters";
  return fmt::format("this machine has no heater {}: it has {}", name, all);
}

int tune_heater(Client& client, const MachineOptions& options, const joblink::HeaterInfo& heater,
                double celsius) {
  take_control(client, options);
  joblink::ClientMessage request;
  request.mutable_tune_heater()->set_kind(heater.kind());
  request.mutable_tune_heater()->set_index(heater.index());
  request.mutable_tune_heater()->set_celsius(celsius);
  client.ask(std::move(request));
  // The node measures without this program: whoever wants to switch it off may do so.
  client.release_control();
  const joblink::Heater measured = watch_tuning(client, heater.name());
  if (measured.tuning().stage() != joblink::TUNING_DONE) return 1;
  print_measured(measured);
  return 0;
}

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
    const joblink::MachineInfo machine =
        client.ask(plain(&joblink::ClientMessage::mutable_get_machine)).machine();
    const joblink::HeaterInfo* heater = heater_called(machine, *name);
    if (heater == nullptr) throw ClientError(no_such_heater(machine, *name));
    take_control(client, *options);
    joblink::ClientMessage request;
    request.mutable_set_temperature()->set_kind(heater->kind());
    request.mutable_set_temperature()->set_index(heater->index());
    request.mutable_set_temperature()->set_celsius(*celsius);
    client.ask(std::move(request));
    if (!watch) return;
    // It heats without this program: whoever wants to switch it off may do so.
    client.release_control();
    exit_code = wait_for_heat(client, *name, *celsius);
  });
}

}  // namespace kinebus
