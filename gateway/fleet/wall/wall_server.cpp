#include "gateway/fleet/wall/wall_server.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "gateway/fleet/queue.hpp"
#include "gateway/fleet/wall/broker_probe.hpp"
#include "gateway/fleet/wall/fleet_metrics.hpp"
#include "gateway/fleet/wall/wall_session.hpp"
#include "gateway/io/listener.hpp"
#include "gateway/io/socket_stream.hpp"
#include "gateway/io/stream_hub.hpp"

namespace kinebus::fleet {
namespace {

using nlohmann::json;
constexpr LocalTime kPeriod = std::chrono::seconds{1};
constexpr int kLooksAMetric = 5;
constexpr LocalTime kTurn = std::chrono::milliseconds{200};

json to_json(const Queue::Seen& seen) {
  const MachineView& view = seen.view;
  return {{"name", view.machine.name},
          {"kind", view.machine.kind},
          {"material", view.machine.material},
          {"nozzle_mm", view.machine.nozzle_mm},
          {"answers", view.answers},
          {"state", view.state},
          {"words", view.words},
          {"job", view.job},
          {"progress", view.progress},
          {"seen_s", seen.seen_s}};
}

std::string look_for_metrics(Queue& queue, std::optional<bool> broker) {
  FleetNumbers numbers{
      .looked_unix_s =
          std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(),
      .broker = broker};
  try {
    numbers.jobs = queue.numbers();
    numbers.machines = queue.machines();
    numbers.database = true;
  } catch (const DatabaseError&) {
    // That is what kinebus_fleet_database_up says.
  }
  return fleet_metrics(numbers);
}

std::string look(Queue& queue) {
  json fleet;
  try {
    const Queue::Totals totals = queue.totals();
    fleet["totals"] = {{"queued", totals.queued},
                       {"assigned", totals.assigned},
                       {"started", totals.started},
                       {"over", totals.over}};
    fleet["machines"] = json::array();
    for (const Queue::Seen& seen : queue.machines()) fleet["machines"].push_back(to_json(seen));
  } catch (const DatabaseError& error) {
    fleet = {{"error", error.what()}};
  }
  return fleet.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

void serve_wall(const WallOptions& options, const std::atomic<bool>& quit) {
  const std::string& address = options.address;
  WallText text;
  EventLoop loop;
  StreamHub hub(loop);
  Listener listener(loop, [&](int fd, const std::string&) {
    hub.add(std::make_unique<SocketStream>(fd), std::make_unique<WallSession>(text));
  });
  if (const std::string wrong = listener.listen_tcp(address); !wrong.empty()) throw std::runtime_error(wrong);
  if (!listener.loopback())
    throw std::runtime_error(address +
                             ": expected an address of this computer alone, as 127.0.0.1:7450 (others come " +
                             "by ssh, or by a server in front that speaks TLS and asks who they are)");
  fmt::print("http://127.0.0.1:{}/\n", listener.port());
  std::fflush(stdout);
  const BrokerProbe broker(options.broker);
  std::thread asker([&] {
    Queue queue(options.database);
    for (int looks = 0; !quit; ++looks) {
      text.set(look(queue));
      if (looks % kLooksAMetric == 0) text.set_metrics(look_for_metrics(queue, broker.works()));
      for (LocalTime waited{0}; !quit && waited < kPeriod; waited += kTurn)
        std::this_thread::sleep_for(kTurn);
    }
  });
  while (!quit) {
    loop.wait(std::min(loop.now() + kTurn, hub.next_deadline()));
    hub.on_time(loop.now());
  }
  asker.join();
}

}  // namespace kinebus::fleet
