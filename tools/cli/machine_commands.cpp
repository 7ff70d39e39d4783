#include "tools/cli/machine_commands.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/cli/client.hpp"
#include "tools/cli/job_watch.hpp"

namespace kinebus {
namespace {

using nlohmann::json;
using Options = std::shared_ptr<MachineOptions>;

int refused(const json& reply) {
  fmt::print(stderr, "kinebus: {}\n", reply.value("error", "refused without a reason"));
  return 1;
}

json status_of(Client& client) {
  return client.ask({{"do", "status"}}).at("status");
}

bool ready(const json& status) {
  return status.value("ready", false);
}
bool brought_up(const json& status) {
  return !status.value("off", true) && !status.value("trouble", true);
}

std::string pose_words(const json& pose) {
  // Rounded first: a coordinate of -1e-9 is shown as 0.000, not as -0.000.
  const auto value = [&](const char* axis) {
    return std::round(pose[axis].get<double>() * 1000) / 1000 + 0.0;
  };
  return fmt::format("X {:.3f}  Y {:.3f}  Z {:.3f} mm   A {:.3f}  C {:.3f} deg   E {:.3f} mm", value("x"),
                     value("y"), value("z"), value("a"), value("c"), value("e"));
}

void print_status(const json& s) {
  fmt::print("{}: {}\n", s["state"].get<std::string>(), s["doing"].get<std::string>());
  if (s["positions_known"].get<bool>())
    fmt::print("tool      {}\n", pose_words(s["pose"]));
  else
    fmt::print("tool      position unknown: home first\n");
  if (!s["job"].get<std::string>().empty())
    fmt::print("job       {}  line {}  {:.1f} %  {} to go\n", s["job"].get<std::string>(),
               s["line"].get<int>(), 100 * s["progress"].get<double>(),
               time_words(s["remaining_s"].get<double>()));
  fmt::print("hotend    {:.1f} / {:.0f} C   bed {:.1f} / {:.0f} C   fan {:.0f} %\n",
             s["hotend"]["actual"].get<double>(), s["hotend"]["target"].get<double>(),
             s["bed"]["actual"].get<double>(), s["bed"]["target"].get<double>(),
             100 * s["fan"].get<double>());
  fmt::print("path      rate {:.2f}   override {:.0f} %   bus {:.1f} % (peak {:.1f} %)\n",
             s["rate"].get<double>(), 100 * s["feed_override"].get<double>(),
             100 * s["bus_load"].get<double>(), 100 * s["bus_load_peak"].get<double>());
}

void print_position(const json& s) {
  fmt::print("part      {}\n", pose_words(s["pose"]));
  fmt::print("machine   {}\n", pose_words(s["machine_pose"]));
  fmt::print("joints   ");
  for (const auto& joint : s["joints"]) fmt::print(" {:.4f}", joint.get<double>());
  fmt::print("\n");
}

void print_nodes(const json& s) {
  fmt::print("node  present  nmt  statusword A/B  queue  sync error  records sent  EMCY\n");
  for (const auto& n : s["nodes"])
    fmt::print("{:4}  {:7}  {:3}     {:04X} / {:04X}  {:5}  {:7} us  {:12}  {:4}\n", n["id"].get<int>(),
               n["present"].get<bool>() ? "yes" : "no", n["nmt"].get<int>(), n["statusword"][0].get<int>(),
               n["statusword"][1].get<int>(), n["queue"].get<int>(), n["sync_error_us"].get<int>(),
               n["records_sent"].get<std::uint64_t>(), n["emergencies"].get<int>());
}

void print_bus(const json& s) {
  fmt::print("load {:.2f} % in the last second, peak {:.2f} %\n", 100 * s["bus_load"].get<double>(),
             100 * s["bus_load_peak"].get<double>());
  for (const auto& [name, value] : s["counters"].items())
    fmt::print("{:20} {}\n", name, value.get<std::uint64_t>());
}

/// A command without arguments that only changes the machine.
void add_plain(CLI::App& app, const Options& options, int& exit_code, const std::string& name,
               const std::string& word, const std::string& help, bool moves) {
  auto* command = app.add_subcommand(name, help);
  auto no_wait = std::make_shared<bool>(false);
  if (moves)
    command->add_flag("--no-wait", *no_wait, "Return at once instead of when the machine is at rest");
  command->callback([=, &exit_code] {
    Client client(Client::find_socket(options->socket));
    client.ask({{"do", "watch"}, {"hz", 10}});
    if (word == "home" && status_of(client).value("off", false)) {
      const json up = client.ask({{"do", "bring-up"}});
      exit_code = up.value("ok", false) ? wait_until_rest(client, brought_up) : refused(up);
      if (exit_code != 0) return;
    }
    const json reply = client.ask({{"do", word}});
    if (!reply.value("ok", false)) {
      exit_code = refused(reply);
      return;
    }
    if (moves && !*no_wait) exit_code = wait_until_rest(client, word == "bring-up" ? brought_up : ready);
  });
}

void add_view(CLI::App& app, const Options& options, const std::string& name, const std::string& help,
              void (*print)(const json&)) {
  app.add_subcommand(name, help)->callback([=] {
    Client client(Client::find_socket(options->socket));
    const json status = status_of(client);
    if (options->json)
      fmt::print("{}\n", status.dump(2));
    else
      print(status);
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
    Client client(Client::find_socket(options->socket));
    client.ask({{"do", "watch"}, {"hz", 10}});
    json request{{"do", "jog"}};
    for (const auto& [key, value] : *values) request[key] = value;
    const json reply = client.ask(request);
    exit_code = reply.value("ok", false) ? wait_until_rest(client, ready) : refused(reply);
  });
}

void add_jobs(CLI::App& app, const Options& options, int& exit_code) {
  app.add_subcommand("jobs", "List the jobs stored on the gateway")->callback([=] {
    Client client(Client::find_socket(options->socket));
    const json reply = client.ask({{"do", "jobs"}});
    for (const auto& job : reply.at("jobs"))
      fmt::print("{:>12}  {}\n", job["bytes"].get<std::uint64_t>(), job["name"].get<std::string>());
  });
  auto* remove = app.add_subcommand("delete", "Delete a stored job");
  auto name = std::make_shared<std::string>();
  remove->add_option("name", *name, "as 'kinebus jobs' lists it")->required();
  remove->callback([=, &exit_code] {
    Client client(Client::find_socket(options->socket));
    const json reply = client.ask({{"do", "delete"}, {"name", *name}});
    if (!reply.value("ok", false)) exit_code = refused(reply);
  });
}

void add_run(CLI::App& app, const Options& options, int& exit_code) {
  auto* run =
      app.add_subcommand("run", "Send a G-code file to the gateway, check it, run it and show its progress");
  auto file = std::make_shared<std::string>();
  auto detach = std::make_shared<bool>(false);
  run->add_option("file", *file, "G-code file, or the name of a stored job")->required();
  run->add_flag("--detach", *detach, "Return when the job has started");
  run->callback([=, &exit_code] {
    Client client(Client::find_socket(options->socket));
    exit_code = run_job(client, *file, *detach);
  });
  app.add_subcommand("watch", "Show the progress of the running job")->callback([=, &exit_code] {
    Client client(Client::find_socket(options->socket));
    client.ask({{"do", "watch"}, {"hz", 5}});
    exit_code = watch_job(client);
  });
}

void add_values(CLI::App& app, const Options& options, int& exit_code) {
  auto* override_command = app.add_subcommand("override", "Set the feed override in per cent");
  auto percent = std::make_shared<double>(100);
  override_command->add_option("percent", *percent)->required()->check(CLI::Range(1.0, 500.0));
  override_command->callback([=, &exit_code] {
    Client client(Client::find_socket(options->socket));
    const json reply = client.ask({{"do", "override"}, {"ratio", *percent / 100}});
    if (!reply.value("ok", false)) exit_code = refused(reply);
  });

  auto* console = app.add_subcommand("console", "Send one G-code or M-code line and print the answer");
  auto words = std::make_shared<std::vector<std::string>>();
  console->add_option("line", *words)->required();
  console->callback([=, &exit_code] {
    Client client(Client::find_socket(options->socket));
    const json reply = client.ask({{"do", "console"}, {"line", fmt::format("{}", fmt::join(*words, " "))}});
    if (reply.value("ok", false))
      fmt::print("{}\n", reply.value("text", ""));
    else
      exit_code = refused(reply);
  });
}

}  // namespace

void add_machine_commands(CLI::App& app, const Options& options, int& exit_code) {
  app.add_option("--socket", options->socket,
                 "The daemon's local socket (default: $KINEBUS_SOCKET, else found)");
  app.add_flag("--as-json", options->json, "Views print the daemon's JSON");
  add_view(app, options, "status", "What the machine does now", print_status);
  add_view(app, options, "position", "Tool and joint positions", print_position);
  add_view(app, options, "nodes", "The nodes on the bus", print_nodes);
  add_view(app, options, "bus", "Bus load and everything that was counted", print_bus);
  add_plain(app, options, exit_code, "bring-up", "bring-up", "Find, check and enable the nodes", true);
  add_plain(app, options, exit_code, "home", "home", "Home the machine (brings the nodes up first)", true);
  add_plain(app, options, exit_code, "reference", "reference", "Go to the print-bed reference position",
            true);
  add_jog(app, options, exit_code);
  add_run(app, options, exit_code);
  add_plain(app, options, exit_code, "hold", "hold", "Feed hold: come to rest on the path", false);
  add_plain(app, options, exit_code, "resume", "resume", "Go on from a hold", false);
  add_plain(app, options, exit_code, "cancel", "cancel", "Come to rest on the path and drop the job", true);
  add_plain(app, options, exit_code, "stop", "stop",
            "Stop now, all carriages together on the path, and stay so", false);
  add_plain(app, options, exit_code, "clear", "clear", "Lift a stop or an alarm", false);
  add_plain(app, options, exit_code, "motors-off", "motors-off",
            "Switch the drives off (the platform must be supported)", false);
  add_values(app, options, exit_code);
  add_jobs(app, options, exit_code);
}

}  // namespace kinebus
