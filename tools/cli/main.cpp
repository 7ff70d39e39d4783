// kinebus: the command line. Each command is in a file of its own.

#include <fmt/format.h>

#include <csignal>
#include <exception>

#include "protocol/host/guarded_main.hpp"
#include "tools/cli/explain_command.hpp"
#include "tools/cli/gcode_command.hpp"
#include "tools/cli/job_commands.hpp"
#include "tools/cli/link_bench.hpp"
#include "tools/cli/machine_commands.hpp"
#include "tools/cli/measure_command.hpp"
#include "tools/cli/plan_command.hpp"
#include "tools/cli/simulate_command.hpp"

namespace {

int run(int argc, char** argv) {
  CLI::App app("kinebus: run, watch, plan and simulate jobs of a Kinebus machine");
  app.require_subcommand(1);
  app.set_version_flag("--version", KINEBUS_VERSION);
  int exit_code = 0;
  const auto options = std::make_shared<kinebus::MachineOptions>();
  kinebus::add_machine_commands(app, options, exit_code);
  kinebus::add_measure_command(app, options);
  kinebus::add_job_commands(app, options, exit_code);
  kinebus::add_link_bench(app, options);
  kinebus::add_plan_command(app, exit_code);
  kinebus::add_simulate_command(app, exit_code);
  kinebus::add_explain_command(app, exit_code);
  kinebus::add_gcode_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "kinebus: {}\n", error.what());
    return 1;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  // A daemon that closes the connection, or a pager that ends, is an error with words, not the end without
  // any.
  std::signal(SIGPIPE, SIG_IGN);
  return kinebus::guarded_main("kinebus", [&] { return run(argc, argv); });
}
