// kinebus-fleet: many machines, one queue.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>

#include "gateway/fleet/commands.hpp"
#include "protocol/host/guarded_main.hpp"
#include "protocol/host/usage.hpp"

namespace {

int run(int argc, char** argv) {
  CLI::App app("kinebus-fleet: one queue of jobs for many machines", "kinebus-fleet");
  app.require_subcommand(1);
  app.fallthrough();
  app.set_version_flag("--version", KINEBUS_VERSION);
  kinebus::fleet::add_commands(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kinebus::kUsageError;
  } catch (const std::exception& error) {
    fmt::print(stderr, "kinebus-fleet: {}\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  return kinebus::guarded_main("kinebus-fleet", [&] { return run(argc, argv); });
}
