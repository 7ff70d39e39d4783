#include "gateway/fleet/commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <atomic>
#include <csignal>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

#include "gateway/fleet/agent.hpp"
#include "gateway/fleet/demo/demo.hpp"
#include "gateway/fleet/queue.hpp"
#include "gateway/fleet/wall/wall_server.hpp"

namespace kinebus::fleet {
namespace {

/// PostgreSQL takes a value of 1 GB at most, and it is in memory several times on its way.
constexpr std::size_t kMostBytes = 256U << 20;
constexpr int kMostCopies = 100'000;
std::atomic<bool> asked_to_end{false};

using Where = std::shared_ptr<std::string>;

void quit_on_signals() {
  std::signal(SIGINT, [](int) { asked_to_end = true; });
  std::signal(SIGTERM, [](int) { asked_to_end = true; });
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (in.bad() || !in.is_open()) throw std::runtime_error(path + ": cannot be read");
  return text;
}

void add_add(CLI::App& app, const Where& where) {
  auto* add = app.add_subcommand("add", "Put a G-code file into the queue");
  auto file = std::make_shared<std::string>();
  auto order = std::make_shared<Queue::Order>();
  add->add_option("file", *file, "G-code file")->required()->check(CLI::ExistingFile);
  add->add_option("--machine-kind", order->kind, "Only machines of this kind (default: any)");
  add->add_option("--material", order->material, "Only machines that have this material (default: any)");
  add->add_option("--nozzle", order->nozzle_mm, "Only machines with this nozzle, mm (default: any)")
      ->check(CLI::Range(0.01, 100.0));
  add->add_option("--priority", order->priority, "Higher ones go first (default: 0)");
  add->add_option("--copies", order->copies, "How many jobs of it")->check(CLI::Range(1, kMostCopies));
  add->callback([=] {
    const std::string text = read_file(*file);
    if (text.empty()) throw std::runtime_error(*file + ": is empty; expected G-code");
    if (text.size() > kMostBytes)
      throw std::runtime_error(*file + ": the queue takes files of 256 MiB at most");
    order->name = file->substr(file->rfind('/') + 1);
    for (const std::int64_t id : Queue(*where).add(text, *order)) fmt::print("{}\n", id);
  });
}

void add_lists(CLI::App& app, const Where& where) {
  auto* jobs = app.add_subcommand("jobs", "List the jobs that are not over, those under way first");
  auto all = std::make_shared<bool>(false);
  auto most = std::make_shared<int>(200);
  jobs->add_flag("--all", *all, "Also those that are over");
  jobs->add_option("--most", *most, "So many lines (default: 200)")->check(CLI::PositiveNumber);
  jobs->callback([=] {
    Queue queue(*where);
    for (const Queue::Listed& job : queue.jobs(*all, *most))
      fmt::print("{:>8}  {:11}  {:16}  {}{}{}\n", job.id, job.state, job.gateway.empty() ? "-" : job.gateway,
                 job.name, job.words.empty() ? "" : "  ", job.words);
    const Queue::Totals totals = queue.totals();
    fmt::print("{} queued, {} assigned, {} started, {} over\n", totals.queued, totals.assigned,
               totals.started, totals.over);
  });
  app.add_subcommand("machines", "List the machines as their agents saw them last")->callback([=] {
    for (const Queue::Seen& seen : Queue(*where).machines())
      fmt::print("{:16}  {:14}  {:>5.1f} %  {:>5.0f} s ago  {}\n", seen.view.machine.name, seen.view.state,
                 100 * seen.view.progress, seen.seen_s,
                 seen.view.job == 0 ? "" : fmt::format("job {}", seen.view.job));
  });
}

void add_changes(CLI::App& app, const Where& where) {
  auto* cancel = app.add_subcommand("cancel", "Cancel a job, wherever it is");
  auto id = std::make_shared<std::int64_t>(0);
  cancel->add_option("job", *id, "as 'kinebus-fleet jobs' lists it")->required();
  cancel->callback([=] {
    if (!Queue(*where).cancel(*id))
      throw std::runtime_error(fmt::format("job {}: there is none of this number that is not over", *id));
  });
  auto* release = app.add_subcommand(
      "release",
      "Queue a job again that a gateway has which is lost: you have looked, and it has not started there");
  auto because = std::make_shared<std::string>();
  release->add_option("job", *id, "as 'kinebus-fleet jobs' lists it")->required();
  release->add_option("--because", *because, "How you know; it is kept with the job")
      ->required()
      ->check([](const std::string& words) {
        return words.size() < 3 ? std::string("expected words") : std::string();
      });
  release->callback([=] {
    if (!Queue(*where).release(*id, *because))
      throw std::runtime_error(fmt::format("job {}: no gateway has it", *id));
  });
}

struct BrokerWords {
  std::string address{}, password_file{};
  Broker::Options options{};
};

void add_broker(CLI::App& command, BrokerWords& broker, const char* what_for) {
  command.add_option("--broker", broker.address, what_for);
  command.add_option("--broker-user", broker.options.user, "Its user");
  command.add_option("--broker-password-file", broker.password_file, "File of the password")
      ->check(CLI::ExistingFile);
}

void add_sparkplug(CLI::App& agent, BrokerWords& broker) {
  agent.add_option("--group", broker.options.group, "Sparkplug's group (default: kinebus)");
  agent.add_option("--node", broker.options.node, "Sparkplug's name of this agent (default: the computer's)");
}

std::optional<Broker::Options> broker_of(const BrokerWords& broker) {
  if (broker.address.empty()) return std::nullopt;
  Broker::Options options = broker.options;
  if (const std::string wrong = read_broker_address(broker.address, options); !wrong.empty())
    throw std::runtime_error("--broker: " + wrong);
  if (!broker.password_file.empty()) {
    std::ifstream in(broker.password_file);
    std::getline(in, options.password);
  }
  std::array<char, 256> host{};
  if (options.node.empty() && ::gethostname(host.data(), host.size() - 1) == 0) options.node = host.data();
  for (const std::string* name : {&options.group, &options.node})
    if (!is_name(*name)) throw std::runtime_error("'" + *name + "': expected " + kNameRule);
  return options;
}

void add_agent(CLI::App& app, const Where& where) {
  auto* agent =
      app.add_subcommand("agent", "Serve gateways: fetch jobs that fit, start each once, follow it");
  auto file = std::make_shared<std::string>();
  auto options = std::make_shared<AgentOptions>();
  auto period_s = std::make_shared<double>(1);
  auto broker = std::make_shared<BrokerWords>();
  agent->add_option("--gateways", *file, "TOML file with a [[gateway]] table for each")
      ->required()
      ->check(CLI::ExistingFile);
  agent->add_flag("--home", options->policy.home,
                  "Home machines whose positions are unknown: only where nobody can be in their way");
  agent->add_flag("--give-up", options->policy.give_up,
                  "Cancel jobs that were interrupted (default: somebody resumes or cancels them)");
  agent->add_option("--period", *period_s, "s between two looks at a gateway (default: 1)")
      ->check(CLI::Range(0.05, 3600.0));
  agent->add_option("--connections", options->connections, "To the database (default: 4)")
      ->check(CLI::Range(1, 64));
  add_broker(
      *agent, *broker,
      "Tell this broker of MQTT (HOST[:PORT]) what the machines do: Sparkplug B, and for Home Assistant "
      "(default: none)");
  add_sparkplug(*agent, *broker);
  agent->callback([=] {
    options->broker = broker_of(*broker);
    auto gateways = read_gateways(read_file(*file));
    if (!gateways) throw std::runtime_error(*file + ": " + gateways.error());
    options->gateways = std::move(*gateways);
    options->database = *where;
    options->period = std::chrono::milliseconds(static_cast<std::int64_t>(*period_s * 1000));
    quit_on_signals();
    run_agent(*options, asked_to_end);
  });
}

void add_serve(CLI::App& app, const Where& where) {
  auto* serve = app.add_subcommand(
      "serve",
      "Show the wall of machines to browsers of this computer, and its numbers to Prometheus (/metrics)");
  auto address = std::make_shared<std::string>("127.0.0.1:7450");
  serve->add_option("--http", *address, "ADDRESS:PORT (default: 127.0.0.1:7450)");
  auto broker = std::make_shared<BrokerWords>();
  add_broker(*serve, *broker,
             "Tell at /metrics, too, whether this broker of MQTT (HOST[:PORT]) answers (default: none)");
  serve->callback([=] {
    broker->options.node = "wall";  // says nothing, and so needs no name of its own
    const auto asked = broker_of(*broker);
    quit_on_signals();
    serve_wall({.database = *where, .address = *address, .broker = asked}, asked_to_end);
  });
}

void add_demo(CLI::App& app) {
  auto* demo = app.add_subcommand(
      "demo",
      "Show a fleet on this computer: its own database and broker, simulated machines, jobs, the wall");
  auto options = std::make_shared<DemoOptions>();
  demo->add_option("--machines", options->machines, "default: 10")->check(CLI::Range(1, 99));
  demo->add_option("--jobs", options->jobs, "default: 30")->check(CLI::Range(0, 10'000));
  demo->add_option("--http", options->http, "ADDRESS:PORT of the wall (default: 127.0.0.1:7450)");
  demo->callback([=] {
    quit_on_signals();
    run_demo(*options, asked_to_end);
  });
}

}  // namespace

void add_commands(CLI::App& app) {
  auto where = std::make_shared<std::string>("dbname=kinebus_fleet");
  app.add_option(
         "--database", *where,
         "PostgreSQL, as libpq reads it (default: $KINEBUS_FLEET_DATABASE, else dbname=kinebus_fleet)")
      ->envname("KINEBUS_FLEET_DATABASE");
  app.add_subcommand("init", "Make the queue's tables where they are missing")->callback([=] {
    Queue(*where).init();
  });
  add_add(app, where);
  add_lists(app, where);
  add_changes(app, where);
  add_agent(app, where);
  add_serve(app, where);
  add_demo(app);
}

}  // namespace kinebus::fleet
