// One motor: its currents, its winding, a short move of it alone.

#include "tools/cli/motor_commands.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "tools/cli/encoder_rows.hpp"
#include "tools/cli/heat_command.hpp"
#include "tools/cli/job_watch.hpp"
#include "tools/cli/message_json.hpp"
#include "tools/cli/status_views.hpp"
#include "tools/cli/tune_command.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using joblink::Status;
constexpr double kRadiansPerDegree = 0.017453292519943295;
constexpr double kMotorStatusHz = 10;

/// Joint by its name, as the machine file has it.
/// `others`: names of other things that would have been right, each with ", " behind it.
std::uint32_t joint_named(const joblink::MachineInfo& machine, const std::string& name,
                          const std::string& others = {}) {
  std::string names;
  for (int i = 0; i < machine.joints_size(); ++i) {
    if (machine.joints(i).name() == name) return static_cast<std::uint32_t>(i);
    names += (i > 0 ? ", " : "") + machine.joints(i).name();
  }
  throw ClientError(fmt::format("there is no {} {}; expected {}{}",
                                others.empty() ? "joint" : "joint or heater", name, others, names));
}

joblink::MachineInfo machine_of(Client& client) {
  ClientMessage request;
  request.mutable_get_machine();
  return client.ask(std::move(request)).machine();
}

void print_currents(const Status& s, const joblink::MachineInfo& machine) {
  fmt::print("joint      node  run       hold      measured  stage\n");
  for (const joblink::Joint& joint : machine.joints())
    if (const joblink::AxisStatus* axis = axis_of(s, joint))
      fmt::print("{:10} {} {}   {:.2f} A    {:.2f} A    {:8}  {}\n", joint.name(), joint.node(),
                 joint.axis() == 0 ? 'A' : 'B', axis->run_current_a(), axis->hold_current_a(),
                 axis->has_current_a() ? fmt::format("{:.2f} A", axis->current_a()) : "-",
                 axis->has_stage_celsius() ? fmt::format("{:.1f} C", axis->stage_celsius()) : "-");
}

/// What the gateway says until `done`; false: not in time.
/// `heard`: in what was said.
bool listen_until(Client& client, std::chrono::seconds time, const std::function<bool(const Status&)>& done,
                  const std::function<void(const joblink::Event&)>& heard = {}) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) {
    const auto report = client.next(std::chrono::seconds{1});
    if (!report) continue;
    if (const auto* event = std::get_if<joblink::Event>(&*report)) {
      if (event->kind() == joblink::EVENT_MESSAGE) fmt::print("{}\n", event->words());
      if (heard) heard(*event);
      continue;
    }
    if (done(std::get<Status>(*report))) return true;
  }
  return false;
}

constexpr auto kCurrentsWithin = std::chrono::seconds{5};
constexpr auto kMeasuredWithin = std::chrono::seconds{60};

}  // namespace

void add_motor_commands(CLI::App& app, const std::shared_ptr<MachineOptions>& options, int& exit_code) {
  auto name = std::make_shared<std::string>();
  auto run = std::make_shared<std::optional<double>>(), hold = std::make_shared<std::optional<double>>();
  auto* current = app.add_subcommand(
      "current", "The motors' currents, or those of one set: kinebus current tower1 --run 1500");
  current->add_option("joint", *name, "Its name in the machine file");
  current->add_option("--run", *run, "mA in motion, peak of a phase")->check(CLI::Range(0, 5000));
  current->add_option("--hold", *hold, "mA at rest (default: the machine file's share of the run current)")
      ->check(CLI::Range(0, 5000));
  current->callback([=, &exit_code] {
    const bool sets = run->has_value() || hold->has_value();
    if (sets == name->empty())
      throw CLI::ValidationError("current", "a joint with --run, --hold or both; or nothing, to see them");
    if (!sets) {
      Client client(options->reach);
      const Status status = with_currents(client);
      if (options->json) return fmt::print("{}", to_json_text(status, {"nodes"}));
      return print_currents(status, machine_of(client));
    }
    Client client(options->reach, kMotorStatusHz, true);
    take_control(client, *options);
    const joblink::MachineInfo machine = machine_of(client);
    ClientMessage request;
    joblink::SetMotorCurrents& set = *request.mutable_set_motor_currents();
    set.set_joint(joint_named(machine, *name));
    if (*run) set.set_run_a(**run * 1e-3);
    if (*hold) set.set_hold_a(**hold * 1e-3);
    const joblink::Joint& joint = machine.joints(static_cast<int>(set.joint()));
    client.ask(std::move(request));
    const auto is = [](double ampere, const std::optional<double>& ma) {
      return !ma || std::abs(ampere * 1000 - *ma) < 1;
    };
    const bool done = listen_until(client, kCurrentsWithin, [&](const Status& s) {
      const joblink::AxisStatus* axis = axis_of(s, joint);
      return axis != nullptr && is(axis->run_current_a(), *run) && is(axis->hold_current_a(), *hold);
    });
    if (done) return;
    fmt::print("{} gets them when the machine stands still\n", *name);
    exit_code = 0;
  });

  auto tuned = std::make_shared<std::string>();
  auto celsius = std::make_shared<std::optional<double>>();
  auto* tune = app.add_subcommand("tune",
                                  "Let a node measure a motor's winding while it stands, or a heater: "
                                  "kinebus tune hotend; or measure what a machine "
                                  "does with a print: kinebus tune vibration, kinebus tune pressure");
  tune->require_subcommand(0, 1);
  add_tune_commands(*tune, options, exit_code);
  tune->add_option("name", *tuned, "A joint's or a heater's name in the machine file");
  tune->add_option("--temperature", *celsius,
                   "C that a heater shall be good at (default: 200 a hot end, 80 a bed, 70 a chamber)")
      ->check(CLI::Range(1.0, 1000.0));
  tune->callback([=, &exit_code] {
    if (!tune->get_subcommands().empty()) return;
    if (tuned->empty()) throw CLI::RequiredError("name");
    Client client(options->reach, kMotorStatusHz, true);
    const joblink::MachineInfo machine = machine_of(client);
    if (const joblink::HeaterInfo* heater = heater_called(machine, *tuned)) {
      exit_code = tune_heater(client, *options, *heater, celsius->value_or(0));
      return;
    }
    if (*celsius) throw ClientError(no_such_heater(machine, *tuned));
    take_control(client, *options);
    ClientMessage request;
    std::string heaters;
    for (const joblink::HeaterInfo& heater : machine.heaters()) heaters += heater.name() + ", ";
    request.mutable_tune_motor()->set_joint(joint_named(machine, *tuned, heaters));
    const joblink::Joint& joint = machine.joints(static_cast<int>(request.tune_motor().joint()));
    client.ask(std::move(request));
    bool found = false;
    const bool done = listen_until(
        client, kMeasuredWithin,
        [&](const Status& s) {
          const joblink::AxisStatus* axis = axis_of(s, joint);
          return axis != nullptr && !axis->measures();
        },
        [&](const joblink::Event& event) {
          found = found || event.words().starts_with(joint.name() + ": measured ");
        });
    if (!done || !found) exit_code = 1;
  });

  auto moved = std::make_shared<std::string>();
  auto distance = std::make_shared<double>(0), speed = std::make_shared<double>(0);
  auto* jog = app.add_subcommand("jog-motor", "Move one joint alone: kinebus jog-motor tower1 2");
  jog->add_option("joint", *moved, "Its name in the machine file")->required();
  jog->add_option("distance", *distance, "mm, or degrees")->required();
  jog->add_option("--speed", *speed, "mm/s (deg/s)")->check(CLI::Range(0.0, 1000.0));
  jog->callback([=, &exit_code] {
    Client client(options->reach, kMotorStatusHz, true);
    take_control(client, *options);
    const joblink::MachineInfo machine = machine_of(client);
    ClientMessage request;
    joblink::JogMotor& asked = *request.mutable_jog_motor();
    asked.set_joint(joint_named(machine, *moved));
    const double unit = machine.joints(static_cast<int>(asked.joint())).rotary() ? kRadiansPerDegree : 1;
    asked.set_distance(*distance * unit);
    asked.set_speed_per_s(*speed * unit);
    client.ask(std::move(request));
    exit_code = wait_until_rest(client, [](const Status& s) { return s.state() == joblink::STATE_READY; });
  });
}

}  // namespace kinebus
