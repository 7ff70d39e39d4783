#include "tools/cli/machine_commands.hpp"

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "tools/cli/console_session.hpp"
#include "tools/cli/heat_command.hpp"
#include "tools/cli/job_watch.hpp"
#include "tools/cli/requests.hpp"
#include "tools/cli/status_views.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using joblink::Status;
using Options = std::shared_ptr<MachineOptions>;
constexpr double kRadians = 0.017453292519943295;
constexpr double kStatusHz = 10;
constexpr auto kClearedWithin = std::chrono::seconds{30};

bool ready(const Status& status) {
  return status.state() == joblink::STATE_READY;
}
bool brought_up(const Status& status) {
  return status.state() != joblink::STATE_OFF && status.state() != joblink::STATE_STOPPED &&
         status.state() != joblink::STATE_ALARM;
}

/// A command without arguments that only changes the machine.
void add_plain(CLI::App& app, const Options& options, int& exit_code, const std::string& name,
               const ClientMessage& request, const std::string& help, bool moves) {
  auto* command = app.add_subcommand(name, help);
  auto no_wait = std::make_shared<bool>(false);
  if (moves)
    command->add_flag("--no-wait", *no_wait, "Return at once instead of when the machine is at rest");
  command->callback([=, &exit_code] {
    Client client(options->reach, moves ? kStatusHz : 0, moves);
    take_control(client, *options);
    if (request.has_home() && client.status().state() == joblink::STATE_OFF) {
      client.ask(plain(&ClientMessage::mutable_bring_up));
      exit_code = wait_until_rest(client, brought_up);
      if (exit_code != 0) return;
    }
    client.ask(request);
    if (moves && !*no_wait) exit_code = wait_until_rest(client, request.has_bring_up() ? brought_up : ready);
  });
}

/// 0: the pin is where it was sent; 1: it is not, and an event has said why.
int wait_for_pin(Client& client) {
  std::string said = "it does not say where its pin is";
  // What was reported before it was told is of no use.
  const double told_s = client.status().time_s();
  for (;;) {
    const auto report = client.next(std::chrono::seconds{20});
    if (!report) break;
    if (const auto* event = std::get_if<joblink::Event>(&*report)) {
      if (event->kind() == joblink::EVENT_MESSAGE) said = event->words();
      continue;
    }
    const auto& status = std::get<Status>(*report);
    const auto pin = status.probe_pin();
    if (status.time_s() < told_s || pin == joblink::PROBE_PIN_MOVES) continue;
    if (pin == joblink::PROBE_PIN_FAILED || pin == joblink::PROBE_PIN_NONE) break;
    fmt::print("{}\n", pin == joblink::PROBE_PIN_OUT  ? "the probe's pin is out"
                       : pin == joblink::PROBE_PIN_IN ? "the probe's pin is in"
                                                      : "the probe tests itself, until it is told in or out");
    return 0;
  }
  fmt::print(stderr, "{}\n", said);
  return 1;
}

void add_pin(CLI::App& app, const std::shared_ptr<MachineOptions>& options, int& exit_code) {
  auto* probe =
      app.add_subcommand("probe", "The pin of a BLTouch: out, in, its self test, the end of an alarm");
  using P = joblink::MoveProbePin;
  const auto orders = [=, &exit_code](const char* name, const char* what, P::Order order) {
    probe->add_subcommand(name, what)->callback([=, &exit_code] {
      Client client(options->reach, 10, true);
      take_control(client, *options);
      ClientMessage request;
      request.mutable_move_probe_pin()->set_order(order);
      client.ask(std::move(request));
      exit_code = wait_for_pin(client);
    });
  };
  orders("out", "As M401", P::OUT);
  orders("in", "As M402", P::IN);
  orders("test", "In and out by itself, until it is told something else", P::SELF_TEST);
  orders("reset", "End its alarm, and draw it in", P::RESET);
  probe->require_subcommand(1);
}

/// 0: the stop is lifted; 1: the gateway has said why not, or says nothing.
int wait_until_cleared(Client& client) {
  const auto end = std::chrono::steady_clock::now() + kClearedWithin;
  while (std::chrono::steady_clock::now() < end) {
    const auto report = client.next(std::chrono::seconds{1});
    if (!report) continue;
    if (const auto* event = std::get_if<joblink::Event>(&*report)) {
      if (event->kind() != joblink::EVENT_ALARM) continue;
      fmt::print(stderr, "ALARM {}\n      {}\n", event->words(), event->advice());
      return 1;
    }
    const auto state = std::get<Status>(*report).state();
    if (state != joblink::STATE_STOPPED && state != joblink::STATE_ALARM) return 0;
  }
  fmt::print(stderr, "kinebus: the gateway has not lifted the stop yet\n");
  return 1;
}

/// A stop that was asked for just now is still under way, and cannot be lifted before it is done.
void wait_until_stopped(Client& client) {
  const auto end = std::chrono::steady_clock::now() + kClearedWithin;
  joblink::State state = client.status().state();
  while (state == joblink::STATE_STOPPING && std::chrono::steady_clock::now() < end)
    if (const auto report = client.next(std::chrono::seconds{1}))
      if (const auto* status = std::get_if<Status>(&*report)) state = status->state();
}

/// Comes back when the stop is lifted: the next command of a script finds the machine so.
void add_clear(CLI::App& app, const Options& options, int& exit_code) {
  app.add_subcommand("clear", "Lift a stop or an alarm")->callback([=, &exit_code] {
    Client client(options->reach, kStatusHz, true);
    take_control(client, *options);
    wait_until_stopped(client);
    client.ask(plain(&ClientMessage::mutable_clear));
    exit_code = wait_until_cleared(client);
  });
}

void add_jog(CLI::App& app, const Options& options, int& exit_code) {
  auto* jog = app.add_subcommand("jog", "Move the tool by a distance: kinebus jog --x 10 --speed 50");
  auto values = std::make_shared<std::map<std::string, double>>();
  for (const char* axis : {"x", "y", "z", "a", "c", "e"})
    jog->add_option_function<double>(
        std::string("--") + axis, [values, axis](const double& v) { (*values)[axis] = v; },
        std::string(axis) == "a" || std::string(axis) == "c" ? "degrees" : "mm");
  jog->add_option_function<double>(
      "--speed", [values](const double& v) { (*values)["speed"] = v; }, "mm/s (deg/s)");
  jog->callback([=, &exit_code] {
    auto& v = *values;
    const bool turns_only = v["x"] == 0 && v["y"] == 0 && v["z"] == 0 && v["e"] == 0;
    ClientMessage request;
    joblink::Pose& delta = *request.mutable_jog()->mutable_delta();
    delta.set_x_mm(v["x"]);
    delta.set_y_mm(v["y"]);
    delta.set_z_mm(v["z"]);
    delta.set_a_rad(v["a"] * kRadians);
    delta.set_c_rad(v["c"] * kRadians);
    delta.set_e_mm(v["e"]);
    request.mutable_jog()->set_speed_per_s(turns_only ? v["speed"] * kRadians : v["speed"]);
    Client client(options->reach, kStatusHz, true);
    take_control(client, *options);
    client.ask(std::move(request));
    exit_code = wait_until_rest(client, ready);
  });
}

void add_values(CLI::App& app, const Options& options, int& exit_code) {
  auto* override_command = app.add_subcommand("override", "Set the feed override in per cent");
  auto percent = std::make_shared<double>(100);
  override_command->add_option("percent", *percent)->required()->check(CLI::Range(1.0, 500.0));
  override_command->callback([=] {
    Client client(options->reach);
    take_control(client, *options);
    ClientMessage request;
    request.mutable_set_override()->set_ratio(*percent / 100);
    client.ask(std::move(request));
  });

  auto* offset =
      app.add_subcommand("work-offset", "Set a work coordinate system: kinebus work-offset 1 --z 0.2");
  auto system = std::make_shared<std::uint32_t>(1);
  auto pose = std::make_shared<joblink::Pose>();
  auto here = std::make_shared<bool>(false);
  offset->add_option("system", *system, "1 for G54 ... 9 for G59.3")->required()->check(CLI::Range(1, 9));
  offset->add_option_function<double>(
      "--x", [pose](const double& v) { pose->set_x_mm(v); }, "mm");
  offset->add_option_function<double>(
      "--y", [pose](const double& v) { pose->set_y_mm(v); }, "mm");
  offset->add_option_function<double>(
      "--z", [pose](const double& v) { pose->set_z_mm(v); }, "mm");
  offset->add_option_function<double>(
      "--a", [pose](const double& v) { pose->set_a_rad(v * kRadians); }, "degrees");
  offset->add_option_function<double>(
      "--c", [pose](const double& v) { pose->set_c_rad(v * kRadians); }, "degrees");
  offset->add_flag("--here", *here, "The tool's present position is to have these coordinates");
  offset->callback([=] {
    Client client(options->reach);
    take_control(client, *options);
    ClientMessage request;
    request.mutable_set_work_offset()->set_system(*system);
    *request.mutable_set_work_offset()->mutable_offset() = *pose;
    request.mutable_set_work_offset()->set_here(*here);
    client.ask(std::move(request));
  });

  auto* mesh = app.add_subcommand("mesh", "The bed's mesh: what is in force and kept, with its heights");
  const auto levels = [=, &exit_code](CLI::App* command, auto line, bool wait) {
    command->callback([=, &exit_code] {
      Client client(options->reach, kStatusHz, true);
      take_control(client, *options);
      exit_code = console_line(client, line(), wait);
    });
  };
  auto mesh_name = std::make_shared<std::string>("default");
  levels(
      mesh->add_subcommand("show", "Heights and meshes kept"), [] { return "M420 V"; }, false);
  levels(
      mesh->add_subcommand("measure", "Probe the grid of [mesh] of the machine file: as G29"),
      [] { return "G29"; }, true);
  levels(
      mesh->add_subcommand("off", "No mesh is in force: as M420 S0"), [] { return "M420 S0"; }, false);
  const auto named = [=](const char* name, const char* what, const char* word) {
    auto* command = mesh->add_subcommand(name, what);
    command->add_option("name", *mesh_name, "Of the mesh");
    levels(
        command, [=] { return fmt::format("BED_MESH_PROFILE {}=\"{}\"", word, *mesh_name); }, false);
  };
  named("use", "The mesh of this name is in force", "LOAD");
  named("keep", "Keep the mesh in force under this name, too", "SAVE");
  named("forget", "Forget the mesh of this name", "REMOVE");
  mesh->require_subcommand(1);

  add_pin(app, options, exit_code);

  auto* console = app.add_subcommand("console",
                                     "Send one G-code or M-code line and print the answer; without a "
                                     "line: a session with history, or lines from a pipe");
  auto words = std::make_shared<std::vector<std::string>>();
  auto no_wait = std::make_shared<bool>(false);
  console->add_option("line", *words);
  console->add_flag("--no-wait", *no_wait, "Return at once instead of when the machine is at rest");
  console->callback([=, &exit_code] {
    Client client(options->reach, kStatusHz, true);
    take_control(client, *options);
    exit_code = words->empty() ? console_session(client)
                               : console_line(client, fmt::format("{}", fmt::join(*words, " ")), !*no_wait);
  });
}

}  // namespace

void take_control(Client& client, const MachineOptions& options) {
  if (!options.force) return;
  ClientMessage request;
  request.mutable_take_control()->set_force(true);
  client.ask(std::move(request));
}

void add_machine_commands(CLI::App& app, const Options& options, int& exit_code) {
  app.add_option("--socket", options->reach.socket,
                 "The daemon's local socket (default: $KINEBUS_SOCKET, else found)");
  app.add_option("--tcp", options->reach.tcp, "HOST:PORT of a daemon that serves TCP");
  app.add_option("--fingerprint", options->reach.fingerprint,
                 "SHA-256 of the daemon's certificate (with --tcp)");
  app.add_option("--token-file", options->reach.token_file, "File with the daemon's token (with --tcp)");
  app.add_flag("--as-json", options->json, "Views, lists and reports print JSON");
  app.add_flag("--force", options->force, "Take control from another client");
  add_views(app, options);
  const auto add = [&](const char* name, const ClientMessage& request, const char* help, bool moves) {
    add_plain(app, options, exit_code, name, request, help, moves);
  };
  using M = ClientMessage;
  add("bring-up", plain(&M::mutable_bring_up), "Find, check and enable the nodes", true);
  add("home", plain(&M::mutable_home), "Home the machine (brings the nodes up first)", true);
  add("reference", plain(&M::mutable_reference), "Go to the print-bed reference position", true);
  add_jog(app, options, exit_code);
  add("hold", plain(&M::mutable_hold), "Feed hold: come to rest on the path", false);
  add("resume", plain(&M::mutable_resume), "Go on from a hold", false);
  add("cancel", plain(&M::mutable_cancel), "Come to rest on the path and drop the job", true);
  add("stop", plain(&M::mutable_stop), "Stop now, all carriages together on the path, and stay so", false);
  add_clear(app, options, exit_code);
  add("motors-off", plain(&M::mutable_motors_off), "Switch the drives off (the platform must be supported)",
      false);
  add_heat(app, options, exit_code);
  add_values(app, options, exit_code);
}

}  // namespace kinebus
