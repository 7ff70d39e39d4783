// kinebus: the command line. Each command is in a file of its own.

#include <fmt/format.h>

#include <csignal>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/near_word.hpp"
#include "protocol/host/guarded_main.hpp"
#include "protocol/host/usage.hpp"
#include "tools/cli/explain_command.hpp"
#include "tools/cli/gcode_command.hpp"
#include "tools/cli/job_commands.hpp"
#include "tools/cli/link_bench.hpp"
#include "tools/cli/machine_commands.hpp"
#include "tools/cli/measure_command.hpp"
#include "tools/cli/motor_commands.hpp"
#include "tools/cli/plan_command.hpp"
#include "tools/cli/shell_words.hpp"
#include "tools/cli/simulate_command.hpp"
#include "tools/cli/users_command.hpp"

namespace {

/// What the first word is that names no command, and which one may be meant; empty: there is no such word.
std::string no_such_command(const CLI::App& app) {
  for (const std::string& word : app.remaining()) {
    if (word.starts_with("-")) continue;
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(command->get_name());
    const std::string_view near = kinebus::near_word(names, word);
    return fmt::format("there is no command '{}'{}; 'kinebus --help' lists them", word,
                       near.empty() ? "" : fmt::format(": did you mean '{}'?", near));
  }
  return {};
}

int run(int argc, char** argv) {
  CLI::App app("kinebus: run, watch, plan and simulate jobs of a Kinebus machine", "kinebus");
  app.require_subcommand(1);
  app.fallthrough();  // --as-json may stand before or behind the command
  app.set_version_flag("--version", KINEBUS_VERSION);
  int exit_code = 0;
  const auto options = std::make_shared<kinebus::MachineOptions>();
  kinebus::add_machine_commands(app, options, exit_code);
  kinebus::add_motor_commands(app, options, exit_code);
  kinebus::add_measure_command(app, options);
  kinebus::add_job_commands(app, options, exit_code);
  kinebus::add_link_bench(app, options);
  kinebus::add_plan_command(app, options->json, exit_code);
  kinebus::add_simulate_command(app, options->json, exit_code);
  kinebus::add_explain_command(app, exit_code);
  kinebus::add_gcode_command(app, exit_code);
  kinebus::add_users_command(app, options->json);
  kinebus::add_shell_words(app, KINEBUS_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    const std::string words = no_such_command(app);
    if (words.empty()) return app.exit(error) == 0 ? 0 : kinebus::kUsageError;
    fmt::print(stderr, "kinebus: {}\n", words);
    return kinebus::kUsageError;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kinebus::kUsageError;
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
