// kinebus-fleet-gateways: many gateways that speak the job link and move nothing, for measuring a fleet.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <memory>
#include <stdexcept>
#include <vector>

#include "gateway/io/listener.hpp"
#include "gateway/io/socket_stream.hpp"
#include "gateway/io/stream_hub.hpp"
#include "protocol/host/guarded_main.hpp"
#include "vcan_tests/fleet/gateways/link_session.hpp"

namespace {

using namespace kinebus;
volatile std::sig_atomic_t quit = 0;
constexpr LocalTime kTurn = std::chrono::milliseconds{50};

int run(int argc, char** argv) {
  CLI::App app("kinebus-fleet-gateways: gateways of a fleet that move nothing");
  std::string folder;
  int first = 0, count = 100;
  double job_s = 0.5;
  app.add_option("--folder", folder, "of sockets and histories")->required()->check(CLI::ExistingDirectory);
  app.add_option("--first", first, "number of the first gateway");
  app.add_option("--count", count, "how many");
  app.add_option("--job", job_s, "s that every job takes");
  CLI11_PARSE(app, argc, argv);
  EventLoop loop;
  StreamHub hub(loop, {.max_streams = 10'000});
  std::vector<std::unique_ptr<fleet::SimulatedGateway>> gateways;
  std::vector<std::unique_ptr<Listener>> listeners;
  for (int number = first; number < first + count; ++number) {
    const std::string name = fmt::format("{}/g{}", folder, number);
    gateways.push_back(std::make_unique<fleet::SimulatedGateway>(
        name + ".history", LocalTime{std::chrono::microseconds{static_cast<std::int64_t>(job_s * 1e6)}}));
    listeners.push_back(
        std::make_unique<Listener>(loop, [&hub, gateway = gateways.back().get()](int fd, const std::string&) {
          hub.add(std::make_unique<SocketStream>(fd), std::make_unique<fleet::LinkSession>(*gateway));
        }));
    if (const std::string wrong = listeners.back()->listen_local(name + ".sock", {}); !wrong.empty())
      throw std::runtime_error(wrong);
  }
  std::signal(SIGTERM, [](int) { quit = 1; });
  while (quit == 0) {
    loop.wait(loop.now() + kTurn);
    for (const auto& gateway : gateways) gateway->on_time(loop.now());
    hub.on_time(loop.now());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-fleet-gateways", [&] { return run(argc, argv); });
}
