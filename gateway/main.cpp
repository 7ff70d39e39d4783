// kinebusd: reads the command line, builds the service, and loops until it is asked to end.

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <memory>

#include "gateway/io/log_queue.hpp"
#include "gateway/service.hpp"
#include "protocol/host/guarded_main.hpp"
#include "protocol/host/realtime.hpp"
#include "protocol/host/usage.hpp"

namespace {

volatile std::sig_atomic_t quit = 0, reread = 0;
void on_signal(int) {
  quit = 1;
}
/// Of a person or systemd: users are read anew. Of the kernel: the terminal in which it was begun is closed.
void on_hang_up(int, siginfo_t* from, void*) {
  (from->si_code == SI_KERNEL ? quit : reread) = 1;
}

int run(int argc, char** argv) {
  kinebus::Arguments arguments;
  CLI::App app("kinebusd: the Kinebus gateway. Plans G-code and moves the machine's CAN nodes.");
  kinebus::add_options(app, arguments);
  if (const auto end = kinebus::parse_arguments(app, argc, argv)) return *end;
  kinebus::keep_stacks_small();
  const auto log = std::make_shared<kinebus::LogQueue>(STDERR_FILENO);
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("kinebusd", log));
  spdlog::set_level(spdlog::level::from_str(arguments.log_level));
  // From here on: who asks it to end while it begins has it begun and ended.
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  struct sigaction hang_up {};
  hang_up.sa_sigaction = on_hang_up;
  hang_up.sa_flags = SA_SIGINFO | SA_RESTART;
  ::sigaction(SIGHUP, &hang_up, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  bool anew = false;
  try {
    kinebus::make_machine_file(arguments);
    kinebus::Service service(arguments);
    service.run(&quit, &reread);
    anew = service.begins_anew() && quit == 0;
  } catch (const std::exception& error) {
    spdlog::critical("{}", error.what());
    return 1;
  }
  if (anew) {
    spdlog::info("begins anew, as a client has asked");
    // The same process to whoever watches it; nodes hold the machine meanwhile.
    ::execv("/proc/self/exe", argv);
    spdlog::critical("cannot begin anew: {}", std::strerror(errno));
    return 1;
  }
  spdlog::info("ended at rest");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebusd", [&] { return run(argc, argv); });
}
